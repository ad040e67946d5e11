//! The sizes that a scan tries.

/// The grid of a scan.
pub(crate) struct Grid {
    /// Smallest and largest size, in typical sizes.
    pub sizes: [f64; 2],
    /// Spacing of the sizes.
    pub spacing: Spacing,
    /// Criterion for the runs that are scanned.
    pub informative: Informative,
    /// Additional fine grid for narrow minima.
    pub narrow_minima: Option<NarrowMinima>,
    /// Number of values of the first shape parameter over its range, spaced by magnitude if the range is; a fit finds
    /// the other shape parameters from their values in the hint.
    pub shapes: usize,
    /// Smallest distance between two sizes of a shape, as a share of the size.
    pub distance: f64,
    /// Number of results of the closer scans.
    pub best: usize,
    /// Half-widths of the closer scans, as shares of the size and of the range of a shape parameter.
    pub closer: &'static [(f64, f64)],
    /// Whether it is scanned with a quasi-static model, without pressure ringing, at a tenth of the time.
    pub quasi_static: bool,
    /// Whether secants respond to the effect: it is then absent if they predict almost nothing.
    pub hinted: bool,
    /// Largest remaining share of the informative runs' loss for a closer scan. While loads and clocks compensate for
    /// what is missing, the bounded loss may stay almost as large at the right size.
    pub remaining_loss: f64,
}

/// Fine grid of sizes with the shape at its upper end. A spool that sticks on a ramp and jumps by the whole band
/// returns to the same places, so the minimum is narrower for smaller bands.
#[derive(Clone, Copy)]
pub(crate) struct NarrowMinima {
    /// Smallest and largest size, in typical sizes.
    pub sizes: [f64; 2],
    /// Relative spacing of the sizes per typical size, and its largest value.
    pub finer: f64,
    pub coarsest: f64,
}

/// Spacing of the sizes.
#[derive(Clone, Copy)]
pub(crate) enum Spacing {
    /// A share of the size.
    Share(f64),
    /// A constant, in typical sizes.
    Even(f64),
}

/// Criterion for the informative runs.
#[derive(Clone, Copy)]
pub(crate) enum Informative {
    /// Runs that a small change of the size changes.
    Changed,
    /// Runs in which the model without the effect has large residuals.
    Failed,
}

/// For switching effects.
pub(crate) static SWITCHING: Grid = Grid {
    sizes: [0.12, 4.0],
    spacing: Spacing::Share(0.008),
    informative: Informative::Changed,
    narrow_minima: Some(NarrowMinima {
        sizes: [0.25, 3.0],
        finer: 0.003,
        coarsest: 0.004,
    }),
    shapes: 3,
    distance: 0.03,
    best: 2,
    closer: &[(0.01, 0.25), (0.002, 0.05), (0.000_4, 0.01)],
    quasi_static: true,
    hinted: true,
    remaining_loss: 0.92,
};

/// For ringing: a minimum extends over a seventh of the size to either side, so that a descent from the grid needs no
/// closer scan.
pub(crate) static RINGING: Grid = Grid {
    sizes: [0.1, 8.0],
    spacing: Spacing::Share(0.06),
    informative: Informative::Changed,
    narrow_minima: None,
    shapes: 5,
    distance: 0.1,
    best: 4,
    closer: &[],
    quasi_static: false,
    hinted: false,
    remaining_loss: f64::INFINITY,
};

/// For located effects: the hitch resting on or reaching the place is reproduced within a few millimetres, and ringing
/// there causes one local minimum per period.
pub(crate) static LOCATED: Grid = Grid {
    sizes: [0.1, 6.5],
    spacing: Spacing::Even(0.06),
    informative: Informative::Failed,
    narrow_minima: None,
    shapes: 5,
    distance: 0.05,
    best: 2,
    closer: &[(0.04, 0.125)],
    quasi_static: true,
    hinted: false,
    remaining_loss: f64::INFINITY,
};

/// The same without ringing: secants show that something is there, though not its stiffness.
pub(crate) static LOCATED_WITHOUT_RINGING: Grid = Grid {
    hinted: true,
    ..LOCATED
};
