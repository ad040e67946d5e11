//! A physics that can be hidden, and how its shape is drawn.

use rand::Rng;
use rand_pcg::Pcg64;

use super::physics::Physics;
use super::test_stand::Family;

/// How true to the textbook a hidden effect is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Fidelity {
    /// The textbook's simplest form.
    Faithful,
    /// With more detail than the simplest form.
    Structured,
}

impl Fidelity {
    /// With more detail, or without.
    #[must_use]
    pub fn of(structured: bool) -> Self {
        if structured {
            Self::Structured
        } else {
            Self::Faithful
        }
    }
}

/// Draws the rest of a shape.
#[derive(Debug)]
pub struct Shape<'a> {
    /// How true to the textbook it is to be.
    pub fidelity: Fidelity,
    /// Where random numbers come from.
    pub random: &'a mut Pcg64,
}

impl Shape<'_> {
    /// Whether the shape has more than the textbook.
    #[must_use]
    pub fn structured(&self) -> bool {
        self.fidelity == Fidelity::Structured
    }

    /// An even random number.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        self.random.random_range(low..high)
    }

    /// `usual` if faithful, else an even random number.
    pub(super) fn usual_or_between(&mut self, usual: f64, low: f64, high: f64) -> f64 {
        if self.structured() {
            self.between(low, high)
        } else {
            usual
        }
    }
}

/// Smallest and largest size.
pub type Sizes = (f64, f64);

/// Gives a rig the physics at a size, with a drawn shape.
pub type Hide = fn(&mut Physics, f64, &mut Shape);

/// A physics that can be hidden.
#[derive(Debug)]
pub struct Hideable {
    /// Id in the catalogue; of an outside effect its name.
    pub id: &'static str,
    /// Unit of its size; empty for a pure number.
    pub unit: &'static str,
    /// Smallest and largest size that is drawn, evenly in the logarithm.
    pub sizes: Sizes,
    /// Whether the size may be negative as well.
    pub signed: bool,
    /// Whether the quasi-static rig can have it.
    pub steady: bool,
    /// Whether the size of the faithful form has the meaning of the catalogue's first parameter.
    pub comparable: bool,
    /// Puts it into a rig.
    pub hide: Hide,
}

impl Hideable {
    /// A physics of positive size that the quasi-static rig can have, with the catalogue's measure of its size.
    #[must_use]
    pub const fn new(id: &'static str, unit: &'static str, sizes: Sizes, hide: Hide) -> Self {
        Self {
            id,
            unit,
            sizes,
            signed: false,
            steady: true,
            comparable: true,
            hide,
        }
    }

    /// Whether a rig of this family can have it.
    #[must_use]
    pub fn fits(&self, family: Family) -> bool {
        self.steady || family == Family::Dynamic
    }

    /// Puts it into a rig at a size; the rest of its shape is drawn.
    pub fn put(&self, rig: &mut Physics, size: f64, fidelity: Fidelity, random: &mut Pcg64) {
        (self.hide)(rig, size, &mut Shape { fidelity, random });
    }

    /// A random size.
    pub fn draw_size(&self, random: &mut impl Rng) -> f64 {
        let (low, high) = self.sizes;
        let size = low * (high / low).powf(random.random::<f64>());
        if self.signed && random.random::<f64>() < 0.4 {
            -size
        } else {
            size
        }
    }
}
