//! Hidden effects of a draft campaign, and what would decide on them.

use hitch_draft::fit::{Effect, Fit, Verdict};
use hitch_draft::next_run::{NextRun, PASS_M, RAISED_S};
use hitch_draft::term::Term;
use schemars::JsonSchema;
use serde::Serialize;

use super::interval::Interval;

/// An effect that the law of draft lacks.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct HiddenEffect {
    /// Its id.
    pub effect: String,
    /// Its name, with the lane of wheel tracks.
    pub name: String,
    /// Whether it is present, absent, or the campaign leaves it open.
    pub verdict: String,
    /// Its probability.
    pub probability: f64,
    /// Unit of its size.
    pub unit: String,
    /// Its size if it is present.
    #[serde(flatten)]
    pub size: Interval,
}

/// What a campaign leaves open.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct Open {
    /// Effects of which the campaign says neither that they are present nor that they are absent.
    pub effects: Vec<String>,
    /// Pairs of effects, of which at least one is present.
    pub confounded: Vec<[String; 2]>,
    /// The run that says most of them.
    pub next_run: String,
}

/// The effects of a fit: of the lanes the most probable one, and others that are present.
pub fn of(fit: &Fit) -> Vec<HiddenEffect> {
    let is_track = |effect: &&Effect| matches!(effect.term, Term::WheelTrack(_));
    let tracks = fit.effects.iter().filter(is_track);
    let most = tracks.max_by(|left, right| left.probability.total_cmp(&right.probability));
    let others = fit.effects.iter().filter(|effect| !is_track(effect));
    let mut effects: Vec<&Effect> = others.chain(most).collect();
    effects.sort_by(|left, right| right.probability.total_cmp(&left.probability));
    effects.iter().map(|effect| shown(fit, effect)).collect()
}

/// What the fit leaves open.
pub fn open(fit: &Fit) -> Option<Open> {
    let next_run = match fit.next_run? {
        NextRun::Raised => format!("{RAISED_S} s with the implement raised, while driving"),
        NextRun::Pass {
            depth_cm,
            speed_km_h,
        } => format!(
            "{PASS_M} m at {depth_cm:.0} cm and {speed_km_h:.1} km/h, on a lane without wheel tracks"
        ),
    };
    let open = fit
        .effects
        .iter()
        .filter(|effect| effect.verdict() == Verdict::Open);
    let pairs = fit.confounded.iter();
    Some(Open {
        effects: open.map(|effect| name(fit, effect.term)).collect(),
        confounded: pairs
            .map(|(left, right)| [name(fit, *left), name(fit, *right)])
            .collect(),
        next_run,
    })
}

fn shown(fit: &Fit, effect: &Effect) -> HiddenEffect {
    let (id, unit) = match effect.term {
        Term::Coefficient(_) => ("", String::new()),
        Term::DraftZero => ("draft-sensor-zero", "N".to_owned()),
        Term::DepthZero => ("depth-sensor-zero", "cm".to_owned()),
        Term::BluntShare => ("blunt-shares", format!("N/{}", fit.machine.width_unit())),
        Term::WheelTrack(_) => ("wheel-track", "1".to_owned()),
    };
    let verdict = match effect.verdict() {
        Verdict::Present => "present",
        Verdict::Absent => "absent",
        Verdict::Open => "open",
    };
    HiddenEffect {
        effect: id.to_owned(),
        name: name(fit, effect.term),
        verdict: verdict.to_owned(),
        probability: effect.probability,
        unit,
        size: effect.size.into(),
    }
}

fn name(fit: &Fit, term: Term) -> String {
    match term {
        Term::Coefficient(power) => format!("coefficient of the speed to the power {power}"),
        Term::DraftZero => "zero of the draft sensor".to_owned(),
        Term::DepthZero => "zero of the depth sensor".to_owned(),
        Term::BluntShare => "blunt shares".to_owned(),
        Term::WheelTrack(lane) => {
            let lane = fit.lanes.get(lane).map_or("", String::as_str);
            format!("wheel track in {lane}")
        }
    }
}
