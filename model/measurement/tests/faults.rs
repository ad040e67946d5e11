//! One fault of a drawn size on a good campaign is named, with its run, its channel and its size within the stated accuracy.

use std::path::Path;

use hitch_campaign::{Bench, Campaign, Run};
use hitch_measurement::{Finding, Kind, check};
use hitch_model_file::named;
use hitch_plant::Channel;

const PUMP: usize = Channel::PumpPressure.index();
const CYLINDER: usize = Channel::CylinderPressure.index();
const FLOW: usize = Channel::Flow.index();
const ANGLE: usize = Channel::RockerAngle.index();
const SEEDS: [u64; 3] = [1, 2, 3];

/// Draws of a fixed seed, by Marsaglia's xorshift.
struct Draws(u64);

impl Draws {
    fn new(seed: u64) -> Self {
        println!("seed {seed}");
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15))
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        low + (high - low) * (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn one_of<T: Clone>(&mut self, items: &[T]) -> T {
        items[self.between(0.0, items.len() as f64) as usize].clone()
    }
}

fn good() -> Campaign {
    let folder =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../host-tests/campaigns/clean-dynamic");
    Campaign::load(&folder).expect("a campaign")
}

/// Runs whose file name begins so.
fn named_runs(campaign: &Campaign, begins: &str) -> Vec<usize> {
    let runs = campaign.runs.iter().enumerate();
    runs.filter(|(_, run)| run.file.starts_with(begins))
        .map(|(at, _)| at)
        .collect()
}

fn channel(run: &mut Run, channel: usize) -> &mut Vec<f64> {
    run.channels[channel].as_mut().expect("a measured channel")
}

/// The only finding with this kind; there are none of other kinds.
fn only(campaign: &Campaign, kind: Kind) -> Finding {
    let model = named("dynamic").expect("a model");
    let mut found = check(campaign, Some(&model));
    assert!(
        found.iter().all(|finding| finding.kind == kind),
        "{found:#?}"
    );
    assert_eq!(found.len(), 1, "{kind:?}: {found:#?}");
    found.remove(0)
}

fn assert_size(finding: &Finding, size: f64) {
    let off = (finding.evidence.value - size).abs();
    assert!(off <= finding.evidence.accuracy, "{size}: {finding:#?}");
}

#[test]
fn zero_of_a_current() {
    for seed in SEEDS {
        let mut draws = Draws::new(seed);
        let offset_a = draws.between(0.015, 0.2);
        let mut all = good();
        for run in &mut all.runs {
            run.lower_current_a.iter_mut().for_each(|a| *a += offset_a);
        }
        let found = only(&all, Kind::CurrentZero);
        assert_eq!(
            (found.run.as_deref(), found.channel),
            (None, Some("lower_current_a"))
        );
        assert_size(&found, offset_a);

        let mut single = good();
        let run = draws.one_of(&named_runs(&single, "duty"));
        single.runs[run]
            .lift_current_a
            .iter_mut()
            .for_each(|a| *a += offset_a);
        let found = only(&single, Kind::CurrentZero);
        assert_eq!(found.run.as_ref(), Some(&single.runs[run].file));
        assert_size(&found, offset_a);
    }
}

#[test]
fn range_of_a_sensor() {
    for seed in SEEDS {
        let limit_bar = Draws::new(seed).between(10.0, 25.0);
        let mut campaign = good();
        for run in &mut campaign.runs {
            channel(run, CYLINDER)
                .iter_mut()
                .for_each(|bar| *bar = bar.min(limit_bar));
        }
        let found = only(&campaign, Kind::Saturated);
        assert_eq!(
            (found.run.as_deref(), found.channel),
            (None, Some("cylinder_pressure_bar"))
        );
        assert_size(&found, limit_bar);
    }
}

#[test]
fn dead_band_and_hold_of_an_instrument() {
    for seed in SEEDS {
        let mut draws = Draws::new(seed);
        let band_lpm = draws.between(0.8, 3.0);
        let mut campaign = good();
        for run in &mut campaign.runs {
            let flow = channel(run, FLOW)
                .iter_mut()
                .filter(|lpm| lpm.abs() < band_lpm);
            flow.for_each(|lpm| *lpm = 0.0);
        }
        assert_eq!(only(&campaign, Kind::DeadBand).channel, Some("flow_lpm"));

        let mut campaign = good();
        let run = draws.one_of(&named_runs(&campaign, "hold"));
        let from = draws.between(100.0, 1000.0) as usize;
        let pressure = channel(&mut campaign.runs[run], CYLINDER);
        let held = pressure[from];
        pressure[from..from + 100].fill(held);
        let found = only(&campaign, Kind::Held);
        assert_eq!(found.run.as_ref(), Some(&campaign.runs[run].file));
        assert_size(&found, held);
    }
}

#[test]
fn spikes() {
    for seed in SEEDS {
        let mut draws = Draws::new(seed);
        let height_bar = draws.between(4.0, 50.0);
        let at = draws.between(100.0, 1400.0) as usize;
        let mut campaign = good();
        let run = named_runs(&campaign, "hold")[0];
        channel(&mut campaign.runs[run], PUMP)[at] += height_bar;
        let found = only(&campaign, Kind::Spikes);
        assert_eq!(found.run.as_ref(), Some(&campaign.runs[run].file));
        assert_eq!(found.from_s, Some(campaign.runs[run].time_s[at]));
        assert_size(&found, height_bar);
    }
}

#[test]
fn signs_of_flow_and_angle() {
    let mut campaign = good();
    for run in &mut campaign.runs {
        channel(run, FLOW)
            .iter_mut()
            .for_each(|lpm| *lpm = lpm.abs());
    }
    assert_eq!(only(&campaign, Kind::FlowSign).run, None);

    let mut campaign = good();
    let run = named_runs(&campaign, "lower")[1];
    channel(&mut campaign.runs[run], ANGLE)
        .iter_mut()
        .for_each(|deg| *deg = 180.0 - *deg);
    let found = only(&campaign, Kind::AngleSign);
    assert_eq!(found.run.as_ref(), Some(&campaign.runs[run].file));

    let hitches = |run: &&mut Run| run.channels[ANGLE].is_some();
    for run in campaign.runs.iter_mut().filter(hitches) {
        channel(run, ANGLE)
            .iter_mut()
            .for_each(|deg| *deg = 180.0 - *deg);
    }
    let run = &mut campaign.runs[run];
    channel(run, ANGLE)
        .iter_mut()
        .for_each(|deg| *deg = 180.0 - *deg);
    assert_eq!(only(&campaign, Kind::AngleSign).run, None);
}

#[test]
fn still_angle_and_dead_pressure() {
    let mut campaign = good();
    let run = named_runs(&campaign, "lift")[0];
    let file = campaign.runs[run].file.clone();
    let angle = channel(&mut campaign.runs[run], ANGLE);
    let rest: Vec<f64> = angle[..20].to_vec();
    let count = angle.len();
    angle
        .iter_mut()
        .zip(rest.iter().cycle().take(count))
        .for_each(|(deg, rest)| *deg = *rest);
    assert_eq!(only(&campaign, Kind::NoMotion).run.as_ref(), Some(&file));

    let mut campaign = good();
    let noise: Vec<f64> =
        channel(&mut campaign.runs[named_runs(&good(), "hold")[0]], CYLINDER).clone();
    let mean = noise.iter().sum::<f64>() / noise.len() as f64;
    let pressure = channel(&mut campaign.runs[run], CYLINDER).iter_mut();
    pressure
        .zip(&noise)
        .for_each(|(bar, noise)| *bar = 0.2 + noise - mean);
    assert_eq!(
        only(&campaign, Kind::DeadPressure).run.as_ref(),
        Some(&file)
    );
}

#[test]
fn unit_of_the_pressures_of_a_run() {
    for seed in SEEDS {
        let mut draws = Draws::new(seed);
        let factor = draws.one_of(&[14.504, 0.1, 0.06895]);
        let mut campaign = good();
        let run = draws.one_of(&named_runs(&campaign, "lower"));
        for pressure in [PUMP, CYLINDER] {
            channel(&mut campaign.runs[run], pressure)
                .iter_mut()
                .for_each(|bar| *bar *= factor);
        }
        let found = only(&campaign, Kind::PressureUnit);
        assert_eq!(found.run.as_ref(), Some(&campaign.runs[run].file));
        assert_size(&found, factor);
    }
}

#[test]
fn load_of_a_run() {
    for seed in SEEDS {
        let mut draws = Draws::new(seed);
        let mut campaign = good();
        let run = draws.one_of(&named_runs(&campaign, "l"));
        let Bench::Hitch { load_kg } = campaign.runs[run].bench else {
            panic!("a hitch");
        };
        let stated_kg = load_kg * draws.between(1.6, 2.5);
        campaign.runs[run].bench = Bench::Hitch { load_kg: stated_kg };
        let found = only(&campaign, Kind::Load);
        assert_eq!(found.run.as_ref(), Some(&campaign.runs[run].file));
        assert_size(&found, load_kg);
    }
}

#[test]
fn exchanged_loads() {
    let mut campaign = good();
    let runs = named_runs(&campaign, "lower_1.6A");
    let (a, b) = (campaign.runs[runs[0]].bench, campaign.runs[runs[1]].bench);
    (campaign.runs[runs[0]].bench, campaign.runs[runs[1]].bench) = (b, a);
    let found = check(&campaign, None);
    assert_eq!(found.len(), 2, "{found:#?}");
    for (finding, other) in found.iter().zip([runs[1], runs[0]]) {
        assert_eq!(finding.kind, Kind::Load);
        assert!(
            finding.seen.contains(&campaign.runs[other].file),
            "{}",
            finding.seen
        );
    }
}

#[test]
fn exchanged_pressures() {
    let mut campaign = good();
    for run in &mut campaign.runs {
        run.channels.swap(PUMP, CYLINDER);
    }
    assert_eq!(only(&campaign, Kind::PumpBelowCylinder).run, None);
}

#[test]
fn repeated_run() {
    let mut campaign = good();
    let mut again = campaign.runs[9].clone();
    again.file = "again.csv".to_owned();
    campaign.runs.push(again);
    assert_eq!(
        only(&campaign, Kind::RepeatedRun).run.as_deref(),
        Some("again.csv")
    );
}

#[test]
fn dead_time_of_a_channel() {
    for seed in SEEDS {
        let mut draws = Draws::new(seed);
        for delayed in [FLOW, ANGLE] {
            let samples = draws.between(15.0, 40.0) as usize;
            let mut campaign = good();
            for run in campaign
                .runs
                .iter_mut()
                .filter(|run| run.channels[delayed].is_some())
            {
                let values = channel(run, delayed);
                values.rotate_right(samples);
                // What was before the log is at rest, as its first samples are.
                let first: Vec<f64> = values[samples..2 * samples].to_vec();
                values[..samples].copy_from_slice(&first);
            }
            let found = only(&campaign, Kind::Delay);
            assert_eq!(found.channel, Some(Channel::ALL[delayed].key()));
            assert_size(&found, samples as f64 * 0.02);
        }
    }
}

#[test]
fn logger() {
    let mut campaign = good();
    for run in &mut campaign.runs {
        run.time_s.iter_mut().for_each(|s| *s *= 3.0);
    }
    campaign.sample_rate_hz /= 3.0;
    assert_size(&only(&campaign, Kind::SampleInterval), 0.06);

    let step_deg = Draws::new(4).between(0.2, 1.0);
    let mut campaign = good();
    for run in campaign
        .runs
        .iter_mut()
        .filter(|run| run.channels[ANGLE].is_some())
    {
        channel(run, ANGLE)
            .iter_mut()
            .for_each(|deg| *deg = (*deg / step_deg).round() * step_deg);
    }
    assert_size(&only(&campaign, Kind::Resolution), step_deg);

    let mut campaign = good();
    let run = &mut campaign.runs[0];
    run.oil_temperature_log_c = Some(run.time_s.iter().map(|s| 40.0 + 0.5 * s).collect());
    assert_eq!(
        only(&campaign, Kind::OilTemperature).run.as_ref(),
        Some(&campaign.runs[0].file)
    );

    let mut campaign = good();
    for run in &mut campaign.runs {
        for (at, a) in run
            .lift_current_a
            .iter_mut()
            .enumerate()
            .filter(|(_, a)| **a > 0.3)
        {
            *a += if at % 2 == 0 { 0.05 } else { -0.05 };
        }
    }
    assert_eq!(
        only(&campaign, Kind::CurrentRipple).channel,
        Some("lift_current_a")
    );
}
