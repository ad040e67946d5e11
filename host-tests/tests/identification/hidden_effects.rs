//! A few fixed cases of the second rig: the hidden effect is named, no effect is named without a hidden one, and
//! physics outside the catalogue is reported as unexplained. `cargo bench -p host-tests --bench hidden_effects` runs
//! many more.

use hitch_campaign::Campaign;
use hitch_identification::data::experiment::Experiment;
use hitch_identification::data::problem::Problem;
use hitch_identification::explanation::explain::{Explanation, explain};
use hitch_plant::Effect;
use host_tests::hidden_effects::answer::Method;
use host_tests::hidden_effects::explaining::Explaining;
use host_tests::hidden_effects::grade::{Graded, Posed};
use host_tests::hidden_effects::starting_point;
use host_tests::second_rig::campaign_writer::{campaign, planned_runs, write};
use host_tests::second_rig::draw::{Case, Kind, Wish, draw};
use host_tests::second_rig::hideable::{Fidelity, find};
use host_tests::second_rig::manoeuvres::Plan;
use host_tests::second_rig::test_stand::Family;

/// Seed, hidden effects, faithful or structured form, good or rough instruments.
type Question = (u64, &'static str, Fidelity, bool);

fn wish(family: Family, plan: Plan, (_, id, fidelity, rough): Question) -> Wish {
    Wish {
        family,
        plan,
        fidelity: Some(fidelity),
        rough: Some(rough),
        kind: Some(Kind::Nothing),
        effect: find(id).map(|what| (what, None)),
        known: |_| true,
    }
}

/// Answers, printed during the test so that a failure can be repeated.
fn ask(family: Family, plan: Plan, questions: &[Question]) -> Vec<Graded> {
    questions
        .iter()
        .map(|&question| {
            let posed = Posed::new(draw(question.0, &wish(family, plan, question)));
            let graded = posed.ask(&Explaining);
            println!(
                "{question:?}: d {:.2}, named {:?} or {:?}, unknown {}, {:.1} s",
                graded.posed.detectability,
                graded.answer.named,
                graded.answer.group,
                graded.answer.unknown,
                graded.seconds
            );
            graded
        })
        .collect()
}

// REQ-DIAG-01
#[test]
fn effects_of_a_steady_rig_are_named_in_the_lab() {
    let graded = ask(
        Family::Steady,
        Plan::Lab,
        &[
            (1, "flow-force", Fidelity::Faithful, false),
            (4, "return-line-loss", Fidelity::Structured, false),
            (5, "pin-friction", Fidelity::Structured, true),
            (6, "lower-threshold-shift", Fidelity::Faithful, true),
        ],
    );
    assert!(graded.iter().filter(|graded| graded.named_first()).count() >= 3);
    assert!(!graded.iter().any(Graded::wrong));
}

// REQ-DIAG-02
#[test]
fn nothing_is_named_where_nothing_is_hidden() {
    let graded = ask(
        Family::Steady,
        Plan::Lab,
        &[(7, "nothing", Fidelity::Faithful, false)],
    );
    assert!(graded[0].answer.named.is_empty() && !graded[0].answer.unknown);
    let rough = ask(
        Family::Steady,
        Plan::Field,
        &[(8, "nothing", Fidelity::Faithful, true)],
    );
    assert!(rough[0].answer.named.is_empty());
}

// REQ-DIAG-03
#[test]
fn an_effect_outside_the_catalogue_is_reported_as_unknown() {
    let graded = ask(
        Family::Steady,
        Plan::Lab,
        &[(9, "cam-error", Fidelity::Faithful, false)],
    );
    assert!(graded[0].answer.unknown);
}

// REQ-DIAG-01
#[test]
fn an_effect_is_named_in_the_field() {
    let graded = ask(
        Family::Steady,
        Plan::Field,
        &[(10, "flow-force", Fidelity::Faithful, true)],
    );
    assert!(graded[0].named_first());
}

/// A campaign of the dynamic rig: the short moves of the lab alone, for ringing pressures take long to simulate.
fn short_moves(question: Question) -> (Case, Campaign) {
    let case = draw(question.0, &wish(Family::Dynamic, Plan::Lab, question));
    let mut measured = campaign(&case);
    measured.runs.retain(|run| {
        ["lift", "lower"]
            .iter()
            .any(|kind| run.file.starts_with(kind))
    });
    (case, measured)
}

// REQ-DIAG-01
#[test]
fn an_effect_is_named_where_pressures_ring() {
    let question = (11, "entrained-air", Fidelity::Faithful, false);
    let (case, measured) = short_moves(question);
    let answer = Explaining.answer(&measured, &starting_point(case.family));
    println!("{question:?}: {answer:?}");
    assert_eq!(answer.named, ["entrained-air"]);
}

/// A case explained from where its family starts.
fn explained(case: &Case) -> Explanation {
    let model = starting_point(case.family);
    explain(
        Problem::new(&Experiment::new(&campaign(case), &model), &model),
        &|_| {},
    )
}

/// The effect that is named first, and the ratio of its size to the hidden one.
fn first_over_truth(case: &Case) -> (&'static dyn Effect, f64) {
    let found = explained(case);
    let first = found.steps.first().expect("something is found");
    let (id, form) = (first.effect.id(), first.effect.form());
    let (found, hidden) = (first.values[0], case.hidden[0].size);
    println!("seed {}, hidden {hidden}: {id} {form:?} {found}", case.seed);
    (first.effect, found / hidden)
}

/// The band of a spool that sticks, which is named first where pressures ring, over the one that it has.
fn band_over_truth(question: Question) -> f64 {
    let case = draw(question.0, &wish(Family::Dynamic, Plan::Lab, question));
    let (named, share) = first_over_truth(&case);
    assert_eq!(named.id(), "spool-stiction");
    share
}

/// A hose that creeps within a second rings much like one that swells at once, whose valley no secant meets.
#[test]
fn an_elastic_hose_is_not_reported_as_creeping() {
    let (named, share) = first_over_truth(&anything(Family::Dynamic, Plan::Lab, 5_133));
    assert_eq!((named.id(), named.form()), ("hose-compliance", None));
    assert!((share - 1.0).abs() < 0.01);
}

/// A tenth of a milliampere beside its band a spool that sticks jumps at other times, and the ringing that follows hides
/// how much better the right one is: it is found all the same, within a thousandth.
#[test]
fn stiction_is_found_with_ringing_pressures() {
    let question = (30, "spool-stiction", Fidelity::Faithful, false);
    assert!((band_over_truth(question) - 1.0).abs() < 1e-3);
}

/// The last of a current's noise shakes the model's spools and rings its pressures; a spool that sticks within it would
/// hold them still, and is not there.
#[test]
fn current_noise_is_not_reported_as_stiction() {
    let question = (23, "nothing", Fidelity::Faithful, true);
    let graded = ask(Family::Dynamic, Plan::Lab, &[question]);
    assert!(graded[0].answer.named.is_empty() && !graded[0].answer.unknown);
}

/// Through the same gap oil of 62 degC leaks 2.7 times as much as oil of 40 degC.
#[test]
fn a_viscosity_dependent_leak_is_explained_completely() {
    let question = (31, "lowering-leakage", Fidelity::Structured, false);
    let graded = ask(Family::Steady, Plan::Lab, &[question]);
    assert_eq!(graded[0].answer.named, ["lowering-leakage"]);
    assert!(!graded[0].answer.unknown);
}

/// Ground that a hitch without inertia only ever rests on is as likely soft and high as hard and low, but there it is,
/// and a landing that comes a hair earlier is no inertia.
#[test]
fn ground_contact_at_rest_is_named_alone() {
    let questions = [
        (917, "ground-contact", Fidelity::Faithful, false),
        (901, "ground-contact", Fidelity::Structured, false),
        (903, "ground-contact", Fidelity::Structured, false),
        (906, "ground-contact", Fidelity::Structured, false),
    ];
    for graded in ask(Family::Steady, Plan::Lab, &questions) {
        assert_eq!(graded.answer.named, ["ground-contact"]);
        assert!(!graded.answer.unknown);
    }
}

/// Cold seals and pipes hold back more, pins turn unevenly, a metering edge is off otherwise when wide open, a load
/// pitches without the links, a compensator is late: the usual form of an effect leaves that unknown, or has others named
/// for it.
#[test]
fn another_form_of_an_effect_is_not_a_second_effect() {
    let questions = [
        (901, "viscous-friction", Fidelity::Structured, false),
        (903, "pin-friction", Fidelity::Structured, false),
        (902, "lower-flow-scale", Fidelity::Structured, false),
        (902, "return-line-loss", Fidelity::Structured, false),
        (931, "load-arm", Fidelity::Structured, false),
        (931, "compensator-droop", Fidelity::Structured, false),
    ];
    for graded in ask(Family::Steady, Plan::Lab, &questions) {
        let case = &graded.posed.case;
        assert_eq!(graded.answer.named, [case.hidden[0].what.id]);
        assert!(!graded.answer.unknown);
    }
}

/// A spool that sticks looks like a hysteresis along every secant, which leaves a quarter of the cost; in fine steps it is
/// found beside it.
#[test]
fn stiction_is_not_reported_as_hysteresis() {
    let case = anything(Family::Steady, Plan::Lab, 5_227);
    let (hidden, size_a) = (case.hidden[0].what.id, case.hidden[0].size);
    let found = explained(&case);
    let first = found.steps.first().expect("something is found");
    println!(
        "{hidden} {size_a} A: {} {:?}",
        first.effect.id(),
        first.values
    );
    assert_eq!(first.effect.id(), hidden);
    assert!((first.values[0] / size_a - 1.0).abs() < 5e-3);
}

/// Whether a spool that follows once loose moves on a step of the current is the same for all bands that are less than the
/// step: slopes over less than a milliampere see nothing of the way to the right one.
#[test]
fn a_stiction_band_is_found_despite_local_minima() {
    let question = (14, "spool-stiction", Fidelity::Structured, false);
    assert!((band_over_truth(question) - 1.0).abs() < 0.05);
}

/// A check valve that takes a little more the more flows, and a lift valve whose curve is off by a little less where it
/// is wide open, are the same on these data: the one with its usual form goes first, and the other is said beside it.
#[test]
fn of_two_confounded_effects_the_usual_one_is_first() {
    for seed in [5_220, 5_234] {
        let case = anything(Family::Steady, Plan::Lab, seed);
        let found = explained(&case);
        let named = ids(found.steps.iter().map(|step| step.effect.id()));
        println!("{seed}: {named:?}");
        assert_eq!(named, ids(case.hidden.iter().map(|hidden| hidden.what.id)));
        let check_valve = found
            .steps
            .iter()
            .find(|step| step.effect.id() == "check-valve-loss");
        let beside = &check_valve.expect("it is named").indistinguishable;
        assert!(
            beside
                .iter()
                .any(|other| other.effect.id() == "lift-flow-scale")
        );
    }
}

/// A campaign as it is drawn, whatever is hidden in it.
fn anything(family: Family, plan: Plan, seed: u64) -> Case {
    drawn(family, plan, seed, None)
}

/// A pair as it is drawn, whatever it is.
fn pair(family: Family, plan: Plan, seed: u64) -> Case {
    drawn(family, plan, seed, Some(Kind::Pair))
}

fn drawn(family: Family, plan: Plan, seed: u64, kind: Option<Kind>) -> Case {
    let any = Wish {
        fidelity: None,
        rough: None,
        kind,
        effect: None,
        ..wish(family, plan, (seed, "", Fidelity::Faithful, false))
    };
    draw(seed, &any)
}

fn ids(names: impl IntoIterator<Item = impl Into<String>>) -> Vec<String> {
    let mut ids: Vec<String> = names.into_iter().map(Into::into).collect();
    ids.sort();
    ids
}

// REQ-DIAG-04
/// As long as the second is missing, the first of two effects may run a held-out run into a stop that its hitch never
/// reached: that a threshold is off shows in all the others. An arm that is there all over the stroke looks like a load
/// that was weighed wrongly in each run.
#[test]
fn two_effects_are_named_though_each_alone_looks_wrong() {
    for seed in [2011, 2016] {
        let case = pair(Family::Dynamic, Plan::Lab, seed);
        let hidden = ids(case.hidden.iter().map(|hidden| hidden.what.id));
        let graded = Posed::new(case).ask(&Explaining);
        println!("{seed}: {hidden:?}, named {:?}", graded.answer.named);
        assert_eq!(ids(graded.answer.named), hidden);
    }
}

/// The jumps of a spool that sticks have to be met to a few hundredths of a percent, though half of the runs are wrong for
/// another reason still: oil that thickens, and a flow force that shuts the lowering valve.
#[test]
fn stiction_is_found_together_with_another_effect() {
    for seed in [6058, 6117] {
        let case = pair(Family::Steady, Plan::Lab, seed);
        let graded = Posed::new(case).ask(&Explaining);
        let named = ids(graded.answer.named);
        println!("{seed}: named {named:?}");
        assert!(named.iter().any(|id| id == "spool-stiction"), "{seed}");
        assert!(named.iter().all(|id| id != "solenoid-hysteresis"), "{seed}");
    }
}

#[test]
fn the_form_of_the_first_effect_is_chosen_anew_with_the_second() {
    let case = pair(Family::Steady, Plan::Field, 3_139);
    let found = explained(&case);
    for step in &found.steps {
        println!(
            "{:?} {:?}: {:?}",
            step.effect.id(),
            step.effect.form(),
            step.values
        );
        let hidden = case
            .hidden
            .iter()
            .find(|hidden| hidden.what.id == step.effect.id());
        let truth = hidden.expect("it is there").size;
        assert_eq!(step.effect.form(), None);
        assert!((step.values[0] / truth - 1.0).abs() < 0.02);
    }
    assert_eq!(found.steps.len(), case.hidden.len());
}

/// A millimetre higher than its ground a hitch hangs, a millimetre lower it stands, and a load rings on stiff ground:
/// the place is found all the same.
#[test]
fn the_ground_is_found_where_loads_ring_on_it() {
    for seed in 13..16 {
        let question = (seed, "ground-contact", Fidelity::Faithful, false);
        let (case, measured) = short_moves(question);
        let model = starting_point(case.family);
        let found = explain(
            Problem::new(&Experiment::new(&measured, &model), &model),
            &|_| {},
        );
        let first = found.steps.first().expect("something is found");
        let (height_m, truth_m) = (first.values[0], case.hidden[0].size);
        println!(
            "{question:?}, {truth_m} m: {} {height_m}",
            first.effect.id()
        );
        assert_eq!(first.effect.id(), "ground-contact");
        assert!((height_m - truth_m).abs() < 1e-3);
    }
}

/// A written campaign equals the measured one.
#[test]
fn a_written_campaign_is_read_back() {
    let question = (12, "angle-sensor-lag", Fidelity::Structured, true);
    let case = draw(question.0, &wish(Family::Steady, Plan::Field, question));
    let folder = tempfile::tempdir().expect("a folder");
    write(&case, &folder.path().join("drawn")).expect("written");
    let read = Campaign::load(&folder.path().join("drawn"));
    let read = read.expect("a sound campaign");
    let measured = campaign(&case);
    assert_eq!(read.runs.len(), planned_runs(&case).len());
    for (read, measured) in read.runs.iter().zip(&measured.runs) {
        assert_eq!(read.bench, measured.bench);
        assert_eq!(read.lift_current_a, measured.lift_current_a);
        // Dropouts are no numbers, so text has to do.
        assert_eq!(
            format!("{:?}", read.channels),
            format!("{:?}", measured.channels)
        );
    }
}
