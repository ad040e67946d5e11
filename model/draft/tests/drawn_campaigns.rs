//! Coverage of the intervals and rate of right names, on campaigns drawn with seeds that served for nothing else.
//!
//! `HITCH_THOROUGH=1 cargo test -p hitch-draft --test drawn_campaigns -- --nocapture` prints the figures of docs/field.md.

use hitch_draft::fit::{Effect, Fit, Verdict, fit};
use hitch_draft::machine::{KINDS, Machine, at_speed};
use hitch_draft::simulated::{Pass, Truth, runs};
use hitch_draft::term::Term;
use hitch_field::draft::Texture;
use hitch_field::noise::Noise;

/// First seed of the drawn campaigns.
const SEED: u64 = 570_000;

/// Number of campaigns: few by day, many with `HITCH_THOROUGH`.
fn cases(few: u64, many: u64) -> u64 {
    if std::env::var_os("HITCH_THOROUGH").is_some() {
        many
    } else {
        few
    }
}

/// Two depths by three speeds, twice, 60 m each; and one run above the soil.
fn passes() -> Vec<Pass> {
    let pass = |depth_m, speed_km_h, length_m| Pass {
        depth_m,
        speed_km_h,
        length_m,
    };
    let mut passes = vec![pass(-0.2, 6.0, 40.0)];
    for depth_m in [0.16, 0.26] {
        for speed_km_h in [4.5, 6.5, 8.5] {
            passes.extend([pass(depth_m, speed_km_h, 60.0); 2]);
        }
    }
    passes
}

/// A machine whose coefficients are anywhere in the standard's range, in soil of a CV of 8 to 19 %.
fn machine(seed: u64) -> Truth {
    let mut noise = Noise::new(seed, 99);
    let kind = KINDS[(seed % 5) as usize];
    let texture = [Texture::Fine, Texture::Medium, Texture::Coarse][(seed % 3) as usize];
    let width = match kind.counts_tools {
        true if kind.name == "subsoiler" => 3.0,
        true => 11.0,
        false => 1.2,
    };
    let mut truth = Truth::standard(Machine {
        kind,
        width,
        texture,
    });
    let range = kind.row.range_percent / 100.0;
    truth.coefficients = truth
        .coefficients
        .map(|coefficient| coefficient * (1.0 + range * (2.0 * noise.uniform() - 1.0)));
    truth.variation = 0.08 + 0.11 * noise.uniform();
    truth
}

fn fitted(truth: &Truth, seed: u64) -> Fit {
    fit(&truth.machine, &runs(truth, &passes(), seed)).expect("there are blocks in the soil")
}

/// Refuses a share of truths inside the 95 % intervals that is below `least` by more than chance.
fn assert_coverage(inside: &[usize; 4], of: u64, least: f64) {
    let deviation = (least * (1.0 - least) / of as f64).sqrt();
    for inside in inside {
        let share = *inside as f64 / of as f64;
        assert!(share > least - 3.0 * deviation, "{share} of {of}");
    }
}

/// What is hidden in the campaigns of a coverage.
#[derive(Clone, Copy, PartialEq)]
enum Drawn {
    /// Nothing.
    Nothing,
    /// Each effect with a probability of 0.5, and its size by its prior.
    ByPrior,
    /// The same with the sizes of [`hide`], which has no small ones.
    Large,
}

/// Hides each effect with a probability of 0.5, with a size by its prior.
fn hide_by_prior(truth: &mut Truth, noise: &mut Noise) {
    let mut size = |mean: f64, deviation: f64| {
        let (is_present, size) = (noise.uniform() < 0.5, mean + deviation * noise.normal());
        if is_present { size } else { 0.0 }
    };
    let usual = at_speed(&truth.machine.standard(), 6.5);
    truth.draft_zero_n = size(0.0, 2000.0);
    truth.depth_zero_m = size(0.0, 0.02);
    truth.blunt_n = size(0.2, 0.1) * usual * 21.0;
    let track = size(0.3, 0.1);
    truth.track = Some((1 + (12.0 * noise.uniform()) as usize, track));
}

/// Numbers of truths inside the intervals of the three coefficients and of the draft at the mean speed, and of campaigns.
fn coverage(what: &str, seed: u64, drawn: Drawn) -> ([usize; 4], u64) {
    let count = cases(10, 200);
    let mut inside = [0; 4];
    let mut width = 0.0;
    for seed in seed..seed + count {
        let mut truth = machine(seed);
        let mut noise = Noise::new(seed, 97);
        match drawn {
            Drawn::Nothing => {}
            Drawn::ByPrior => hide_by_prior(&mut truth, &mut noise),
            Drawn::Large => {
                for effect in 1..HIDDEN.len() {
                    if noise.uniform() < 0.5 {
                        hide(&mut truth, effect, seed);
                    }
                }
            }
        }
        let fit = fitted(&truth, seed);
        let speed = fit.reference.speed_km_h;
        let level = fit.specific_draft(speed);
        let is_inside =
            |[low, high]: [f64; 2], value: f64| usize::from(low <= value && value <= high);
        for (power, inside) in inside.iter_mut().enumerate().take(3) {
            let interval = fit.coefficients[power].interval();
            *inside += is_inside(interval, truth.coefficients[power]);
        }
        inside[3] += is_inside(level.interval(), at_speed(&truth.coefficients, speed));
        width += level.deviation * 1.96 / level.mean;
    }
    println!(
        "{what}, seeds from {seed}: half interval of the level {:.1} %",
        100.0 * width / count as f64
    );
    let names = ["F A", "F B", "F C", "draft at the mean speed"];
    for (name, inside) in names.iter().zip(inside) {
        println!("{what}, {name}: {inside} of {count} inside");
    }
    (inside, count)
}

#[test]
fn intervals_contain_the_truth_with_effects_as_expected() {
    let (inside, of) = coverage("effects by their priors", SEED + 20_000, Drawn::ByPrior);
    assert_coverage(&inside, of, 0.95);
}

#[test]
fn intervals_contain_the_truth_without_effects() {
    // The mean over models has a part of effects that are absent here, most of which raise the draft.
    let (inside, of) = coverage("no effects", SEED, Drawn::Nothing);
    assert_coverage(&inside, of, 0.92);
}

#[test]
fn intervals_contain_most_truths_with_large_effects() {
    // A depth zero of 2 to 4 cm is one to two deviations of its prior in every campaign.
    let (inside, of) = coverage("large effects", SEED + 20_000, Drawn::Large);
    assert_coverage(&inside, of, 0.85);
}

/// An effect that is hidden in a campaign.
const HIDDEN: [&str; 5] = [
    "none",
    "draft zero",
    "depth zero",
    "blunt shares",
    "wheel track",
];

fn hide(truth: &mut Truth, effect: usize, seed: u64) {
    let mut noise = Noise::new(seed, 98);
    let usual = at_speed(&truth.coefficients, 6.5);
    let sign = if noise.uniform() < 0.5 { -1.0 } else { 1.0 };
    match effect {
        1 => truth.draft_zero_n = sign * (1000.0 + 2000.0 * noise.uniform()),
        2 => truth.depth_zero_m = sign * (0.02 + 0.02 * noise.uniform()),
        3 => truth.blunt_n = (0.15 + 0.2 * noise.uniform()) * usual * 21.0,
        4 => {
            truth.track = Some((
                1 + (12.0 * noise.uniform()) as usize,
                0.2 + 0.2 * noise.uniform(),
            ))
        }
        _ => {}
    }
}

fn number(term: Term) -> usize {
    match term {
        Term::Coefficient(_) => 0,
        Term::DraftZero => 1,
        Term::DepthZero => 2,
        Term::BluntShare => 3,
        Term::WheelTrack(_) => 4,
    }
}

#[test]
fn hidden_effects_are_named() {
    let count = cases(2, 40);
    let (mut all, mut all_wrong, mut clear) = (0, 0, 0);
    for hidden in 0..5 {
        let (mut right, mut wrong, mut inside, mut open) = (0, 0, 0, 0);
        for seed in SEED + 10_000..SEED + 10_000 + count {
            let mut truth = machine(seed);
            hide(&mut truth, hidden, seed);
            let fit = fitted(&truth, seed);
            let mut text = format!("{} {seed} {}:", HIDDEN[hidden], truth.machine.kind.name);
            for effect in &fit.effects {
                if effect.probability > 0.2 {
                    text += &format!(" {:?} {:.2}", effect.term, effect.probability);
                }
                if effect.probability < 0.95 {
                    continue;
                }
                let is_lane = |lane| truth.track.is_some_and(|(run, _)| run == lane);
                let is_right = number(effect.term) == hidden
                    && match effect.term {
                        Term::WheelTrack(lane) => is_lane(lane),
                        _ => true,
                    };
                if !is_right {
                    wrong += 1;
                    continue;
                }
                right += 1;
                let [low, high] = effect.size.interval();
                let size = [
                    0.0,
                    truth.draft_zero_n,
                    100.0 * truth.depth_zero_m,
                    truth.blunt_n,
                    truth.track.map_or(0.0, |(_, increase)| increase),
                ][hidden];
                inside += usize::from(low <= size && size <= high);
            }
            let is_open = |effect: &Effect| {
                number(effect.term) == hidden && effect.verdict() == Verdict::Open
            };
            open += usize::from(fit.effects.iter().any(is_open));
            println!("{text}");
        }
        println!(
            "{}: {right} of {count} named, {wrong} wrong names, {inside} of {right} sizes inside, {open} open",
            HIDDEN[hidden]
        );
        all += count;
        all_wrong += wrong;
        // The zero of the depth sensor and blunt shares are told apart by the speed alone.
        clear += if hidden == 1 || hidden == 4 { right } else { 0 };
    }
    assert!(clear as f64 >= 0.75 * 2.0 * count as f64, "{clear} named");
    assert!(
        all_wrong as f64 <= 0.05 * all as f64 + 1.0,
        "{all_wrong} wrong names"
    );
}
