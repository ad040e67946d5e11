//! The next experiment: proposed for campaigns with two indistinguishable effects, then measured, then decisive.

use std::time::Instant;

use hitch_effects::find;
use hitch_identification::adequacy::signal::Signal;
use hitch_identification::data::experiment::Experiment;
use hitch_identification::data::problem::Problem;
use hitch_identification::design::alternative::Replacement;
use hitch_identification::design::exploration::exploring;
use hitch_identification::design::feasibility::is_feasible;
use hitch_identification::design::levels::Levels;
use hitch_identification::design::manoeuvre::TEMPLATES;
use hitch_identification::design::plan::{Manoeuvre, RunPlan, Segment, Stand};
use hitch_identification::design::separation::TestBench;
use hitch_identification::design::{NextExperiment, Pair, Rival, next_experiment};
use hitch_identification::estimate::Estimate;
use hitch_identification::estimation::fit::{Fit, evaluate, refine};
use hitch_identification::explanation::explain::{Explanation, ExplanationStep, Verdict};
use hitch_identification::selection::candidate::weigh;
use hitch_identification::selection::evidence::DISTINGUISHABLE;
use hitch_plant::{AddedEffect, Currents};
use truth_rigs::lab::Lab;
use truth_rigs::second_rig::test_stand::{Family, SAMPLE_RATE_HZ};

const ALL: [bool; 4] = [true; 4];
const NO_PUMP_SENSOR: [bool; 4] = [false, true, true, true];
const ANGLE_ONLY: [bool; 4] = [false, false, false, true];

const fn lift(lift_a: f64, ramp_s: f64, stay_s: f64) -> Segment {
    let lower_a = 0.0;
    let to = Currents { lift_a, lower_a };
    Segment { to, ramp_s, stay_s }
}

const fn lower(lower_a: f64, ramp_s: f64, stay_s: f64) -> Segment {
    let lift_a = 0.0;
    let to = Currents { lift_a, lower_a };
    Segment { to, ramp_s, stay_s }
}

fn hitch(load_kg: f64, start: f64, course: &[Segment]) -> RunPlan {
    RunPlan {
        stand: Stand::Hitch { load_kg, start },
        oil_temperature_c: 40.0,
        course: course.to_vec(),
    }
}

/// The one load of the campaigns, kg.
const LOAD_KG: f64 = 150.0;

/// Steps up from rest at one load, each log ended before the current falls.
fn rising_lifts() -> Vec<RunPlan> {
    let lifts = [(1.3, 4.0), (1.5, 3.0), (1.9, 1.5), (2.4, 1.0)];
    lifts
        .map(|(lift_a, stay_s)| hitch(LOAD_KG, 0.1, &[lift(lift_a, 0.01, stay_s)]))
        .to_vec()
}

/// Lifts and lowerings in steps, at one load.
fn steps() -> Vec<RunPlan> {
    let lifts = [(1.4, 3.0), (1.8, 1.5), (2.4, 1.0)].map(|(lift_a, stay_s)| {
        let course = [lift(lift_a, 0.2, stay_s), lift(0.0, 0.2, 1.0)];
        hitch(LOAD_KG, 0.1, &course)
    });
    let lowerings = [(1.6, 3.0), (1.9, 1.5), (2.4, 0.8)].map(|(lower_a, stay_s)| {
        let course = [lower(lower_a, 0.2, stay_s), lower(0.0, 0.2, 1.0)];
        hitch(LOAD_KG, 0.9, &course)
    });
    [lifts, lowerings].concat()
}

/// The listed manoeuvres on the machine of a lab.
fn manoeuvres(lab: &Lab) -> Vec<Manoeuvre> {
    let levels = Levels::new(&lab.experiment(), &lab.model);
    let templates = TEMPLATES.iter();
    templates.map(|template| template.on(&levels)).collect()
}

/// An effect of the catalogue at its usual size.
fn effect(id: &str) -> AddedEffect {
    AddedEffect::typical(find(id).expect("in the catalogue"))
}

/// An effect and its usual size.
fn usual(id: &'static str) -> (&'static str, f64) {
    (id, effect(id).values[0])
}

/// The manoeuvre that an experiment proposes.
fn proposed(next: &NextExperiment) -> Manoeuvre {
    let proposal = next.proposal.clone();
    proposal
        .unwrap_or_else(|| panic!("a listed manoeuvre, not {next}"))
        .manoeuvre
}

/// Ids of the effects that an explanation names, and whether it leaves any of them open.
fn named(explanation: &Explanation) -> (Vec<&'static str>, bool) {
    let steps = explanation.steps.iter();
    let open = |step: &ExplanationStep| !step.indistinguishable.is_empty();
    (
        steps.clone().map(|step| step.effect.id()).collect(),
        steps.clone().any(open),
    )
}

/// Explains a campaign that leaves a hidden effect ambiguous, measures the proposal, and explains again: then the
/// hidden effect is named without alternatives. Returns the proposal and the former alternatives.
fn closes(hidden: &str, lab: &mut Lab) -> (Manoeuvre, Vec<&'static str>) {
    let first = lab.explain();
    assert_eq!(first.verdict, Verdict::Ambiguous, "{:?}", named(&first));
    let next = first.next_experiment.expect("ambiguous");
    let pairs = next.separates.iter().map(|(a, b)| [a.id(), b.id()]);
    let rivals: Vec<&str> = pairs
        .filter(|pair| pair.contains(&hidden))
        .flatten()
        .filter(|id| *id != hidden)
        .collect();
    assert!(!rivals.is_empty(), "{hidden}: {next}");
    let manoeuvre = proposed(&next);
    lab.measure(&manoeuvre.runs);
    let second = lab.explain();
    let step = second.steps.iter().find(|step| step.effect.id() == hidden);
    let step = step.unwrap_or_else(|| panic!("{hidden}, not {:?}", named(&second)));
    let others = step.indistinguishable.iter().map(|a| a.effect.id());
    let left: Vec<&str> = others.filter(|id| rivals.contains(id)).collect();
    assert!(left.is_empty(), "{hidden} or {left:?}");
    (manoeuvre, rivals)
}

/// Whether a manoeuvre is at another load than the campaigns of these tests, or at a port pressure.
fn changes_pressure(manoeuvre: &Manoeuvre) -> bool {
    let new = |run: &RunPlan| match run.stand {
        Stand::Hitch { load_kg, .. } => load_kg != LOAD_KG,
        Stand::Flow { .. } => true,
    };
    manoeuvre.runs.iter().any(new)
}

/// At one load and without a pump pressure sensor, compensator droop and a smaller orifice are indistinguishable.
#[test]
fn a_drooping_compensator_is_told_from_a_scaled_flow_by_another_load() {
    for (hidden, size, twin) in [
        ("compensator-droop", 0.005, "lift-flow-scale"),
        ("lift-flow-scale", 0.04, "compensator-droop"),
    ] {
        let mut lab = Lab::new(Family::Steady, (hidden, size), NO_PUMP_SENSOR, &steps());
        let (manoeuvre, rivals) = closes(hidden, &mut lab);
        assert!(rivals.contains(&twin), "{hidden} or {rivals:?}");
        assert!(changes_pressure(&manoeuvre), "{}", manoeuvre.name);
    }
}

/// On rising currents hysteresis resembles a threshold shift; a falling current separates them.
#[test]
fn hysteresis_is_told_from_a_threshold_by_a_current_that_comes_back() {
    let ids = ["solenoid-hysteresis", "lift-threshold-shift"];
    let lab = Lab::new(Family::Steady, usual(ids[0]), ALL, &rising_lifts());
    let twins = Twins::new(&lab, ids);
    let next = next_experiment(Problem::new(&twins.experiment, &lab.model), &[twins.pair()]);
    let manoeuvre = proposed(&next.expect("a pair"));
    let comes_back = ["triangle", "reversals", "staircase"];
    assert!(
        comes_back.iter().any(|kind| manoeuvre.name.contains(kind)),
        "{}",
        manoeuvre.name
    );
}

/// Both effects of a pair fitted to the measurements of a lab, and the angle between them.
struct Twins {
    experiment: Experiment,
    fits: [Fit; 2],
    angle_deg: f64,
}

impl Twins {
    fn new(lab: &Lab, ids: [&str; 2]) -> Self {
        let experiment = lab.experiment();
        let fits = ids.map(|id| {
            let start = Estimate::new(&experiment, vec![effect(id)]);
            refine(Problem::new(&experiment, &lab.model), start)
        });
        let other = &fits[1].estimate.effects[0];
        let problem = Problem::new(&experiment, &lab.model);
        Self {
            angle_deg: Replacement::new(problem, &fits[0], 0).angle_deg(other),
            fits,
            experiment,
        }
    }

    fn pair(&self) -> Pair<'_> {
        let [named, other] = self.fits.each_ref().map(|fit| Rival {
            effect: fit.estimate.effects[0].effect,
            fit,
        });
        Pair { named, other }
    }
}

// REQ-DIAG-10
/// Confounded effects of the catalogue are close on plain steps, and far apart with the proposal.
#[test]
fn the_proposed_experiment_separates_confounded_effects() {
    for (ids, channels, plans) in [
        (
            ["solenoid-hysteresis", "lift-threshold-shift"],
            ALL,
            rising_lifts(),
        ),
        (
            ["compensator-droop", "lift-flow-scale"],
            NO_PUMP_SENSOR,
            steps(),
        ),
        (["coulomb-friction", "pin-friction"], ALL, steps()),
    ] {
        let mut lab = Lab::new(Family::Steady, usual(ids[0]), channels, &plans);
        let before = Twins::new(&lab, ids);
        let next = next_experiment(
            Problem::new(&before.experiment, &lab.model),
            &[before.pair()],
        );
        let next = next.expect("a pair");
        let manoeuvre = proposed(&next);
        lab.measure(&manoeuvre.runs);
        let after = Twins::new(&lab, ids).angle_deg;
        let before = before.angle_deg;
        assert!(
            before < 15.0 && after > 20.0,
            "{ids:?}: {before} to {after} degrees"
        );
    }
}

/// Air in the oil and a soft hose ring alike until the pressure changes: by another load or by hard steps.
#[test]
fn a_ringing_plant_is_designed_for_as_well() {
    let ids = ["entrained-air", "hose-compliance"];
    let lab = Lab::new(Family::Dynamic, usual(ids[0]), ALL, &steps());
    let twins = Twins::new(&lab, ids);
    let next = next_experiment(Problem::new(&twins.experiment, &lab.model), &[twins.pair()]);
    let next = next.expect("a pair");
    let manoeuvre = proposed(&next);
    assert!(
        changes_pressure(&manoeuvre) || manoeuvre.name.contains("steps"),
        "{next}"
    );
    assert!(next.expected_likelihood_ratio >= DISTINGUISHABLE, "{next}");
}

/// The selection among the manoeuvres whose pressures were all simulated before.
fn selected_of_all(problem: Problem<'_>, pair: Pair<'_>) -> Option<String> {
    let bench = TestBench::new(problem, pair.named.fit);
    let known = [bench.known(pair)];
    let levels = Levels::new(problem.experiment, problem.model);
    let machine = bench.with(pair.named);
    let listed = TEMPLATES.iter().map(|template| template.on(&levels));
    let possible: Vec<Manoeuvre> = listed
        .filter(|manoeuvre| is_feasible(manoeuvre, &levels, &machine, bench.rate_hz()))
        .collect();
    // Concurrently, as the selection is, so that their times can be compared.
    let ratios: Vec<f64> = std::thread::scope(|scope| {
        let judge = |manoeuvre| {
            let (bench, known) = (&bench, &known);
            scope.spawn(move || bench.likelihood_ratios(manoeuvre, known)[0])
        };
        let judged: Vec<_> = possible.iter().map(judge).collect();
        judged.into_iter().map(|one| one.join().unwrap()).collect()
    });
    // A ratio of 26 is decisive; below it, the largest one per minute of the distinguishable ones counts.
    let best = ratios.iter().copied().fold(0.0, f64::max);
    let bar = if best >= 26.0 { 26.0 } else { DISTINGUISHABLE };
    let candidates = possible.iter().zip(ratios);
    candidates
        .filter(|(_, ratio)| *ratio >= bar)
        .max_by(|a, b| (a.1 / a.0.minutes()).total_cmp(&(b.1 / b.0.minutes())))
        .map(|(manoeuvre, _)| manoeuvre.instruction.clone())
}

/// Only the pressures of the best manoeuvres are simulated: the selection is that of all that are possible.
#[test]
fn the_selection_does_not_depend_on_when_the_pressures_are_checked() {
    for (family, ids, channels) in [
        (
            Family::Steady,
            ["compensator-droop", "lift-flow-scale"],
            NO_PUMP_SENSOR,
        ),
        (
            Family::Steady,
            ["solenoid-hysteresis", "lift-threshold-shift"],
            ALL,
        ),
        (Family::Dynamic, ["entrained-air", "hose-compliance"], ALL),
    ] {
        let lab = Lab::new(family, usual(ids[0]), channels, &steps());
        let twins = Twins::new(&lab, ids);
        let problem = Problem::new(&twins.experiment, &lab.model);
        let start = Instant::now();
        let next = next_experiment(problem, &[twins.pair()]).expect("a pair");
        let own = start.elapsed();
        let start = Instant::now();
        let expected = selected_of_all(problem, twins.pair()).expect("a manoeuvre");
        println!(
            "{ids:?}: {own:.2?}; with all simulated {:.2?}",
            start.elapsed()
        );
        assert_eq!(next.manoeuvre, expected, "{ids:?}");
    }
}

/// Without a pressure sensor, pin friction and a reduced flow are indistinguishable in every manoeuvre.
#[test]
fn a_sensor_is_asked_for_where_no_manoeuvre_helps() {
    let ids = ["pin-friction", "lower-flow-scale"];
    let lab = Lab::new(Family::Steady, usual(ids[0]), ANGLE_ONLY, &steps());
    let twins = Twins::new(&lab, ids);
    assert!(twins.angle_deg < 3.0, "{}", twins.angle_deg);
    let next = next_experiment(Problem::new(&twins.experiment, &lab.model), &[twins.pair()]);
    let next = next.expect("a pair");
    assert!(next.separates.is_empty() && next.minutes.is_nan());
    assert!(next.expected_likelihood_ratio < DISTINGUISHABLE);
    let sentence = next.to_string();
    assert!(
        sentence.starts_with("none of the listed manoeuvres"),
        "{sentence}"
    );
    assert!(
        sentence.ends_with("a pressure sensor at the cylinder"),
        "{sentence}"
    );
}

// REQ-DIAG-10
/// The predicted separation equals that of a measurement.
#[test]
fn the_expected_likelihood_ratio_is_met() {
    let ids = ["compensator-droop", "lift-flow-scale"];
    let lab = || Lab::new(Family::Steady, usual(ids[0]), NO_PUMP_SENSOR, &steps());
    let excess = |twins: &Twins| twins.fits[1].cost - twins.fits[0].cost;
    let first = lab();
    let listed = manoeuvres(&first);
    let twins = Twins::new(&first, ids);
    let bench = TestBench::new(
        Problem::new(&twins.experiment, &first.model),
        &twins.fits[0],
    );
    let known = [bench.known(twins.pair())];
    for name in ["light-and-heavy-lift", "creep-and-stop", "full-opening"] {
        let manoeuvre = listed.iter().find(|manoeuvre| manoeuvre.name == name);
        let manoeuvre = manoeuvre.expect("listed");
        let expected = bench.likelihood_ratios(manoeuvre, &known)[0];
        let mut more = lab();
        more.measure(&manoeuvre.runs);
        let measured = Twins::new(&more, ids);
        let own = measured.fits[0].clone();
        let base = evaluate(
            Problem::new(&measured.experiment, &more.model),
            Estimate::new(&measured.experiment, vec![]),
        );
        let inflation = weigh(
            Problem::new(&measured.experiment, &more.model),
            &base,
            own,
            0,
        )
        .inflation;
        let found = (excess(&measured) - excess(&twins)) / inflation;
        assert!(
            (0.5..3.0).contains(&(found / expected)),
            "{name}: {found}, not {expected}"
        );
    }
}

#[test]
fn manoeuvres_can_be_carried_out() {
    let lab = Lab::new(Family::Steady, usual("solenoid-hysteresis"), ALL, &steps());
    let manoeuvres = manoeuvres(&lab);
    for (index, manoeuvre) in manoeuvres.iter().enumerate() {
        let name = manoeuvre.name;
        assert!(
            manoeuvres[..index].iter().all(|other| other.name != name),
            "{name} twice"
        );
        assert!(!manoeuvre.instruction.ends_with('.') && !manoeuvre.runs.is_empty());
        assert!(
            (1.0..60.0).contains(&manoeuvre.minutes()),
            "{name}: {}",
            manoeuvre.minutes()
        );
        for run in &manoeuvre.runs {
            for time_s in run.time_s(SAMPLE_RATE_HZ) {
                let Currents { lift_a, lower_a } = run.currents(time_s);
                assert!(
                    (0.0..=3.5).contains(&lift_a) && (0.0..=3.5).contains(&lower_a),
                    "{name}"
                );
                assert!(
                    lift_a == 0.0 || lower_a == 0.0,
                    "{name}: both coils at {time_s} s"
                );
            }
            let end = run.currents(run.duration_s());
            assert_eq!(end, Currents::default(), "{name} leaves a valve open");
        }
    }
}

/// The manoeuvre for an unexplained error uses the valve that is off, whatever the error depends on.
#[test]
fn an_unexplained_error_is_explored_where_it_is() {
    for (hidden, valve, motion) in [
        ("lower-threshold-shift", "lowering current", "lowering"),
        ("lift-threshold-shift", "lift", "lifting"),
    ] {
        let lab = Lab::new(Family::Steady, usual(hidden), ALL, &steps());
        let experiment = lab.experiment();
        let problem = Problem::new(&experiment, &lab.model);
        let fit = evaluate(problem, Estimate::new(&experiment, Vec::new()));
        for depends_on in [[Signal::Load], [Signal::Flow], [Signal::RockerAngle]] {
            let next = exploring(problem, &fit, &depends_on);
            println!("{hidden}, {depends_on:?}: {next}");
            let uses = next.manoeuvre.contains(valve) || next.manoeuvre.contains(motion);
            let uses =
                uses || next.manoeuvre.contains("lower from") || next.manoeuvre.contains("creep");
            assert!(
                uses && next.why.contains(&format!("while {motion}")),
                "{next}"
            );
        }
    }
}
