//! Machines that differ from the data sheet in many small ways, and then change.
//!
//! The rig has three to five structural differences; the initial model has errors of some percent in every constant.
//! The first campaign is for adopting the machine, the second one has one to three changes, and the third one repeats
//! the second with other manoeuvres and noise.

use rand::seq::IndexedRandom;
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;

use super::draw::{Case, Hidden, Kind};
use super::hidden::{Fidelity, Hideable};
use super::hideable::HIDEABLE;
use super::instruments::Instruments;
use super::manoeuvres::Plan;
use super::physics::Physics;
use super::test_stand::Family;

/// Streams of random numbers that are apart from those of the other cases.
const STREAM: u64 = 0x0066_6f72_6569_676e;

/// Share of the usual range of sizes, in the logarithm, from which a machine's own structures are drawn.
const OWN_RANGE: f64 = 0.5;

/// Factors by which a structure that the machine has may change.
const GROWTH: (f64, f64) = (1.6, 2.5);

/// Probability that one of the changes is one of a structure that the machine has.
const OWN_CHANGES: f64 = 0.5;

/// Effects that share numbers of the rig's physics with others: they cannot be there beside those.
const SHARED: [&str; 2] = ["stribeck-friction", "spool-stiction"];

/// A machine without a true data sheet.
#[derive(Debug, Clone)]
pub struct Foreign {
    /// Seed.
    pub seed: u64,
    /// Its structures, by id and size.
    pub own: Vec<(&'static str, f64)>,
    /// The campaign from which it is adopted.
    pub first: Case,
    /// The campaign after the changes, which are the hidden effects.
    pub second: Case,
    /// The same machine measured once more.
    pub third: Case,
}

/// Draws a foreign machine; the same seed gives the same one.
#[must_use]
pub fn draw_foreign(seed: u64, family: Family, plan: Plan) -> Foreign {
    let mut random = Pcg64::seed_from_u64(seed ^ STREAM);
    let pool: Vec<&'static Hideable> = HIDEABLE
        .iter()
        .filter(|what| what.fits(family) && !SHARED.contains(&what.id))
        .collect();
    let count = random.random_range(3..=5);
    let mut own: Vec<(&'static Hideable, f64)> = Vec::new();
    for &what in pool.choose_multiple(&mut random, count) {
        let (low, high) = what.sizes;
        let size = low * (high / low).powf(OWN_RANGE * random.random::<f64>());
        let negative = what.signed && random.random::<bool>();
        own.push((what, if negative { -size } else { size }));
    }
    let physics = physics_of(&own, &mut random);
    let changes = changes(&pool, &own, &mut random);
    let case = |campaign: u64, hidden: Vec<Hidden>| Case {
        seed: seed.wrapping_mul(3).wrapping_add(campaign),
        family,
        plan,
        fidelity: Fidelity::Faithful,
        rough: true,
        kind: match hidden.len() {
            0 => Kind::Nothing,
            1 => Kind::Single,
            _ => Kind::Pair,
        },
        hidden,
        unnamed: physics.clone(),
        instruments: Instruments::good(),
    };
    Foreign {
        seed,
        own: own.iter().map(|(what, size)| (what.id, *size)).collect(),
        first: case(0, Vec::new()),
        second: case(1, changes.clone()),
        third: case(2, changes),
    }
}

/// The rig with its own structures, each with more than the textbook's form.
fn physics_of(own: &[(&'static Hideable, f64)], random: &mut Pcg64) -> Physics {
    let mut physics = Physics {
        unnamed_force_n: random.random_range(3.0..12.0),
        unnamed_wobble: random.random_range(0.0005..0.002),
        ..Physics::default()
    };
    for (what, size) in own {
        what.put(&mut physics, *size, Fidelity::Structured, random);
    }
    physics
}

/// One to three changes, of existing or new effects.
fn changes(
    pool: &[&'static Hideable],
    own: &[(&'static Hideable, f64)],
    random: &mut Pcg64,
) -> Vec<Hidden> {
    let count = random.random_range(1..=3);
    let mut changes = Vec::new();
    if random.random::<f64>() < OWN_CHANGES
        && let Some((what, size)) = own.choose(random)
    {
        let size = size * random.random_range(GROWTH.0..GROWTH.1);
        changes.push(Hidden::new(what, size, random.random()));
    }
    let is_new = |what: &&&Hideable| own.iter().all(|(own, _)| own.id != what.id);
    let new: Vec<&'static Hideable> = pool.iter().filter(is_new).copied().collect();
    let others = new.choose_multiple(random, count - changes.len().min(count));
    for what in others.copied().collect::<Vec<_>>() {
        let size = what.draw_size(random);
        changes.push(Hidden::new(what, size, random.random()));
    }
    changes
}
