//! Openings of the valves.

/// Opening of a valve.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Opening {
    /// Flow at the reference drop, m3/s.
    pub flow_m3_s: f64,
    /// Current beyond the threshold, A; zero if nothing depends on it.
    pub beyond_threshold_a: f64,
}

impl Opening {
    /// Whether the valve is closed.
    #[inline(always)]
    #[must_use]
    pub fn shut(&self) -> bool {
        self.flow_m3_s <= 0.0
    }

    /// Linear interpolation between this opening and another.
    #[inline(always)]
    fn towards(&self, to: &Self, share: f64) -> Self {
        let between = |from: f64, to: f64| from + (to - from) * share;
        Self {
            flow_m3_s: between(self.flow_m3_s, to.flow_m3_s),
            beyond_threshold_a: between(self.beyond_threshold_a, to.beyond_threshold_a),
        }
    }

    /// The same opening with its flow multiplied by `factor`.
    #[inline(always)]
    pub(crate) fn scaled(self, factor: f64) -> Self {
        Self {
            flow_m3_s: self.flow_m3_s * factor,
            ..self
        }
    }
}

/// Openings of the two valves.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Openings {
    /// Lift valve.
    pub lift: Opening,
    /// Lowering valve.
    pub lower: Opening,
}

impl Openings {
    /// Whether both valves are closed.
    #[inline(always)]
    #[must_use]
    pub fn shut(&self) -> bool {
        self.lift.shut() && self.lower.shut()
    }

    /// Whether the total opening of both valves is larger than that of others.
    #[inline(always)]
    #[must_use]
    pub fn wider_than(&self, others: &Self) -> bool {
        let width = |of: &Self| of.lift.flow_m3_s + of.lower.flow_m3_s;
        width(self) > width(others)
    }

    /// Linear interpolation between these openings and others.
    #[inline(always)]
    #[must_use]
    pub fn towards(&self, to: &Self, share: f64) -> Self {
        Self {
            lift: self.lift.towards(&to.lift, share),
            lower: self.lower.towards(&to.lower, share),
        }
    }
}
