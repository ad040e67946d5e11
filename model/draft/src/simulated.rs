//! Campaigns drawn from the model of the field, with effects that their manifest does not mention.

use hitch_field::implement::Penetration;
use hitch_field::noise::Noise;
use hitch_field::sensors::draft_pins::{DraftPins, DraftPinsConstants};
use hitch_field::sensors::lagged::{Lagged, LaggedConstants};
use hitch_field::soil::{Soil, SoilPlan, Stretch};

use crate::block::{Run, Sample};
use crate::machine::{Machine, at_speed};

/// A run as it is driven.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pass {
    /// Depth that the links set, m; negative when raised.
    pub depth_m: f64,
    /// Speed, km/h.
    pub speed_km_h: f64,
    /// Length, m.
    pub length_m: f64,
}

/// What is true in a drawn campaign.
#[derive(Debug, Clone, PartialEq)]
pub struct Truth {
    /// Implement and soil, as the manifest says.
    pub machine: Machine,
    /// `F A`, `F B`, `F C` of this implement in this soil.
    pub coefficients: [f64; 3],
    /// Coefficient of variation of the soil's strength, 1.
    pub variation: f64,
    /// Offset of both pins together, N.
    pub draft_zero_n: f64,
    /// What the depth sensor lacks, m.
    pub depth_zero_m: f64,
    /// Force on blunt edges, N per m or tool.
    pub blunt_n: f64,
    /// Index of the run in wheel tracks, and its relative increase of the draft.
    pub track: Option<(usize, f64)>,
}

impl Truth {
    /// The standard's implement without effects, in soil of the usual variation.
    #[must_use]
    pub fn standard(machine: Machine) -> Self {
        Self {
            machine,
            coefficients: machine.standard(),
            variation: 0.12,
            draft_zero_n: 0.0,
            depth_zero_m: 0.0,
            blunt_n: 0.0,
            track: None,
        }
    }
}

/// Time between samples, s.
const STEP_S: f64 = 0.05;
/// Length over which the implement follows the links, m.
const FOLLOWS_M: f64 = 1.5;

/// Draws the runs of a campaign from a seed, each on its own lane.
#[must_use]
pub fn runs(truth: &Truth, passes: &[Pass], seed: u64) -> Vec<Run> {
    let drawn = passes.iter().enumerate();
    drawn
        .map(|(index, pass)| Run {
            name: format!("run-{}", index + 1),
            lane: format!("run-{}", index + 1),
            samples: samples(truth, pass, index, seed),
        })
        .collect()
}

fn samples(truth: &Truth, pass: &Pass, index: usize, seed: u64) -> Vec<Sample> {
    let stream = 10 * index as u64;
    let noise = |of: u64| Noise::new(seed, stream + of);
    let mut plan = SoilPlan::varying(truth.machine.texture);
    plan.strength.coefficient_of_variation = truth.variation;
    if let Some((_, increase)) = truth.track.filter(|(run, _)| *run == index) {
        let draft_factor = 1.0 + increase;
        plan.stretches.push(Stretch {
            draft_factor,
            is_headland: false,
            ..Stretch::headland(0.0, pass.length_m)
        });
    }
    let mut soil = Soil::new(plan, noise(0));
    let mut constants = DraftPinsConstants::two_of_40_kn();
    // The two pins share the offset.
    let offset = 0.25 * 0.5 * truth.draft_zero_n / constants.left.nominal_n;
    constants.left.zero_offset = offset;
    constants.right.zero_offset = offset;
    let nominal_n = constants.left.nominal_n;
    let mut pins = DraftPins::new(constants, noise(1));
    let depth = LaggedConstants {
        offset: -truth.depth_zero_m,
        ..LaggedConstants::depth()
    };
    let mut depth = Lagged::new(depth, pass.depth_m.min(0.0), noise(2));
    let mut radar = Lagged::new(LaggedConstants::radar(), pass.speed_km_h / 3.6, noise(3));
    let mut share = Penetration::new(pass.depth_m.min(0.0));
    let mut driver = noise(4);
    let (mut slow, mut travel_m, mut time_s) = (0.0, 0.0, 0.0);
    let mut samples = Vec::new();
    while travel_m < pass.length_m {
        // The driver holds the speed to 2 %, over some seconds.
        slow += -slow * STEP_S / 3.0 + 0.02 * (2.0 * STEP_S / 3.0).sqrt() * driver.normal();
        let speed_m_s = pass.speed_km_h / 3.6 * (1.0 + slow);
        travel_m += speed_m_s * STEP_S;
        time_s += STEP_S;
        share.advance(pass.depth_m, FOLLOWS_M, speed_m_s * STEP_S);
        let strength = soil.draft_factor(travel_m);
        let deep_cm = 100.0 * share.depth_m().max(0.0);
        let specific = at_speed(&truth.coefficients, 3.6 * speed_m_s) * deep_cm;
        let blunt = if deep_cm > 0.0 { truth.blunt_n } else { 0.0 };
        let draft_n = strength * truth.machine.width * (specific + blunt);
        let read = pins.read(draft_n);
        let pin_n = |ratio: f64| (ratio - 0.5) / 0.25 * nominal_n;
        samples.push(Sample {
            time_s,
            speed_m_s: radar.read(speed_m_s, STEP_S),
            depth_m: depth.read(share.depth_m(), STEP_S),
            draft_n: pin_n(read.left) + pin_n(read.right),
        });
    }
    samples
}
