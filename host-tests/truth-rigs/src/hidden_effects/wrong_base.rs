//! Declared models that differ from the machine as a data sheet does.

use hitch_plant::{Constants, Model, Valve, ValveCurve};
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;

use super::starting_point;
use crate::second_rig::test_stand::Family;

/// One sigma of the relative errors of a flow curve: common to all points, growing from the threshold to the current
/// limit, bent in between, and of each point.
const CURVE_SCALE: f64 = 0.08;
const CURVE_SLOPE: f64 = 0.05;
const CURVE_BEND: f64 = 0.03;
const CURVE_POINT: f64 = 0.005;

/// One sigma of a threshold current, A.
const THRESHOLD_A: f64 = 0.02;

/// Errors are cut off at this many sigmas.
const FARTHEST: f64 = 2.0;

/// Stream of random numbers, apart from those of the campaigns.
const STREAM: u64 = 0x7772_6f6e_6762_6173;

/// The model of a family with every constant off as on a data sheet, drawn with a seed.
#[must_use]
pub fn declared(family: Family, seed: u64) -> Model {
    declared_within(family, seed, 1.0)
}

/// The same with errors that are a share of those of a data sheet: a fitted model is off by a few hundredths.
#[must_use]
pub fn declared_within(family: Family, seed: u64, share: f64) -> Model {
    let mut random = Pcg64::seed_from_u64(seed ^ STREAM);
    let mut constants = starting_point(family).constants().clone();
    for valve in Valve::BOTH {
        let curve = &mut valve.of_mut(&mut constants).curve;
        *curve = wrong_curve(curve, share, &mut random);
    }
    spoil(&mut constants, share, &mut random);
    Model::new("data sheet", constants).expect("the dimensions differ by less than a percent")
}

fn draw(random: &mut Pcg64) -> f64 {
    let error: f64 = StandardNormal.sample(random);
    error.clamp(-FARTHEST, FARTHEST)
}

fn wrong_curve(curve: &ValveCurve, share: f64, random: &mut Pcg64) -> ValveCurve {
    let threshold_a = curve.threshold_a();
    let last_a = curve.currents_a().last().copied().unwrap_or(threshold_a);
    let shift_a = share * THRESHOLD_A * draw(random);
    let [scale, slope, bend] =
        [CURVE_SCALE, CURVE_SLOPE, CURVE_BEND].map(|sigma| share * sigma * draw(random));
    let points = curve.currents_a().iter().zip(curve.flows_m3_s());
    let (mut currents_a, mut flows_m3_s) = (Vec::new(), Vec::new());
    for (&current_a, &flow_m3_s) in points {
        let way = (current_a - threshold_a).max(0.0) / (last_a - threshold_a);
        let bent = 4.0 * way * (1.0 - way);
        let error = scale + slope * way + bend * bent + share * CURVE_POINT * draw(random);
        currents_a.push(if current_a > 0.0 {
            current_a + shift_a
        } else {
            0.0
        });
        let least = flows_m3_s.last().copied().unwrap_or(0.0);
        flows_m3_s.push(f64::max(flow_m3_s * (1.0 + error), least));
    }
    ValveCurve::new(currents_a, flows_m3_s).expect("the currents rise, the flows do not fall")
}

/// Puts the other constants off by a share of their tolerances, one sigma.
fn spoil(constants: &mut Constants, share: f64, random: &mut Pcg64) {
    let constants = [
        (&mut constants.pump.theoretical_flow_m3_s, 0.03),
        (&mut constants.relief_valve.set_pressure_pa, 0.05),
        (&mut constants.compensator.margin_pa, 0.08),
        (&mut constants.check_valve.cracking_pressure_pa, 0.1),
        (&mut constants.cylinder.bore_m, 0.005),
        (&mut constants.linkage.rocker_arm_m, 0.003),
        (&mut constants.masses.dead_weight_kg, 0.05),
        (&mut constants.spool_time_constant_s, 0.15),
        (&mut constants.cylinder.viscous_friction_n_s_m, 0.2),
        (&mut constants.oil.bulk_modulus_pa, 0.15),
    ];
    put_off(
        constants.map(|(value, sigma)| (value, share * sigma)),
        random,
    );
}

/// Multiplies each value by one plus a drawn error with this sigma.
pub(super) fn put_off<'v>(
    values: impl IntoIterator<Item = (&'v mut f64, f64)>,
    random: &mut Pcg64,
) {
    for (value, sigma) in values {
        *value *= 1.0 + sigma * draw(random);
    }
}
