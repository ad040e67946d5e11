//! Draws a case from a seed: hidden effects, plan, and instruments.

use rand::seq::IndexedRandom;
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

use super::hidden::{Fidelity, Hideable};
use super::hideable::HIDEABLE;
use super::instruments::Instruments;
use super::manoeuvres::Plan;
use super::outside::OUTSIDE;
use super::physics::Physics;
use super::test_stand::Family;

/// Kind of a case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, clap::ValueEnum)]
pub enum Kind {
    /// One effect of the catalogue.
    Single,
    /// Two effects of the catalogue.
    Pair,
    /// Nothing.
    Nothing,
    /// Something that is in no catalogue.
    Outside,
}

/// Something that is hidden, and how large it is.
#[derive(Debug, Clone, Copy)]
pub struct Hidden {
    /// The effect.
    pub what: &'static Hideable,
    /// Its size, in its unit.
    pub size: f64,
    /// Seed of its remaining shape.
    shape_seed: u64,
}

impl Hidden {
    /// Something of a size, with the rest of its shape drawn from a seed.
    #[must_use]
    pub fn new(what: &'static Hideable, size: f64, shape_seed: u64) -> Self {
        Self {
            what,
            size,
            shape_seed,
        }
    }
}

/// Constraints of a drawn case; the rest is drawn.
#[derive(Debug, Clone, Copy)]
pub struct Wish {
    /// The rig.
    pub family: Family,
    /// Plan.
    pub plan: Plan,
    /// How true to the textbook the hidden effects are.
    pub fidelity: Option<Fidelity>,
    /// Slow noise, wrong weights, noisy currents, unnamed physics.
    pub rough: Option<bool>,
    /// Kind of the hidden effects.
    pub kind: Option<Kind>,
    /// Which effect is hidden, and how large if that is not to be drawn; makes it a single one.
    pub effect: Option<(&'static Hideable, Option<f64>)>,
    /// Which effects of the catalogue may be drawn.
    pub known: fn(&str) -> bool,
}

/// A rig with something hidden in it, and how it is measured.
#[derive(Debug, Clone)]
pub struct Case {
    /// Seed.
    pub seed: u64,
    /// The rig.
    pub family: Family,
    /// Plan.
    pub plan: Plan,
    /// How true to the textbook the hidden effects are.
    pub fidelity: Fidelity,
    /// Whether noise is slow, weights are wrong and unnamed physics is about.
    pub rough: bool,
    /// Kind of the hidden effects.
    pub kind: Kind,
    /// The hidden effects.
    pub hidden: Vec<Hidden>,
    /// The rig without the hidden effects: its structural details, and physics outside the catalogue.
    pub(super) unnamed: Physics,
    /// The instruments.
    pub instruments: Instruments,
}

impl Case {
    /// The rig's physics.
    #[must_use]
    pub fn physics(&self) -> Physics {
        self.physics_with(|_| true)
    }

    /// The rig's physics with only some of the hidden effects.
    #[must_use]
    pub fn physics_with(&self, chosen: impl Fn(&Hidden) -> bool) -> Physics {
        let mut physics = self.unnamed.clone();
        for hidden in self.hidden.iter().filter(|hidden| chosen(hidden)) {
            let mut random = Pcg64::seed_from_u64(hidden.shape_seed);
            let (what, size) = (hidden.what, hidden.size);
            what.put(&mut physics, size, self.fidelity, &mut random);
        }
        physics
    }
}

/// Draws a case; the same seed and wish give the same one.
#[must_use]
pub fn draw(seed: u64, wish: &Wish) -> Case {
    let mut random = Pcg64::seed_from_u64(seed);
    let structured = random.random::<bool>();
    let rough = random.random::<bool>();
    let kind = random.random::<f64>();
    let fidelity = wish.fidelity.unwrap_or(Fidelity::of(structured));
    let rough = wish.rough.unwrap_or(rough);
    let kind = match (wish.effect, wish.kind) {
        (Some(_), _) => Kind::Single,
        (None, Some(kind)) => kind,
        // Most cases have one effect, as is typical in practice.
        (None, None) if kind < 0.55 => Kind::Single,
        (None, None) if kind < 0.75 => Kind::Pair,
        (None, None) if kind < 0.87 => Kind::Nothing,
        (None, None) => Kind::Outside,
    };
    let hidden = draw_hidden(wish, kind, &mut random);
    let mut unnamed = Physics::default();
    if rough {
        unnamed.unnamed_force_n = random.random_range(3.0..12.0);
        unnamed.unnamed_wobble = random.random_range(0.0005..0.002);
    }
    let instruments = draw_instruments(rough, wish.plan, &mut random);
    Case {
        seed,
        family: wish.family,
        plan: wish.plan,
        fidelity,
        rough,
        kind,
        hidden,
        unnamed,
        instruments,
    }
}

fn draw_hidden(wish: &Wish, kind: Kind, random: &mut Pcg64) -> Vec<Hidden> {
    let from: Vec<&'static Hideable> = match kind {
        Kind::Outside => OUTSIDE.iter().collect(),
        _ => HIDEABLE
            .iter()
            .filter(|what| what.fits(wish.family) && (wish.known)(what.id))
            .collect(),
    };
    let count = match kind {
        Kind::Nothing => 0,
        Kind::Single | Kind::Outside => 1,
        Kind::Pair => 2,
    };
    let drawn: Vec<&'static Hideable> = match wish.effect {
        Some((what, _)) => vec![what],
        None => from.choose_multiple(random, count).copied().collect(),
    };
    drawn
        .into_iter()
        .map(|what| {
            let size = what.draw_size(random);
            let wanted = wish.effect.and_then(|(_, size)| size);
            Hidden::new(what, wanted.unwrap_or(size), random.random())
        })
        .collect()
}

/// A lab logs everything; in the field a channel may be missing, late or full of gaps.
fn draw_instruments(rough: bool, plan: Plan, random: &mut Pcg64) -> Instruments {
    let mut instruments = Instruments::good();
    if rough {
        instruments.slow_share = 0.2;
        instruments.current_sigma_a = random.random_range(0.003..0.005);
        instruments.late_samples[random.random_range(0..4)] = random.random_range(0..2);
    }
    if rough && plan == Plan::Field {
        instruments.dropouts_per_minute = random.random_range(0.0..10.0);
        let missing = random.random_range(0..6);
        if missing < 3 {
            instruments.logged[missing] = false;
        }
    }
    instruments
}
