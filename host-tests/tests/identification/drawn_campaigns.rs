//! Properties of an explanation over drawn campaigns: it is no worse than what was seen on the way, and it ends with its time.

use std::sync::Mutex;
use std::time::{Duration, Instant};

use hitch_identification::data::experiment::Experiment;
use hitch_identification::data::limit::Limit;
use hitch_identification::data::problem::Problem;
use hitch_identification::estimation::fit::Fit;
use hitch_identification::explanation::explain::{Explanation, explain_with};
use hitch_identification::search::options::Options;
use host_tests::seeds::cases;
use truth_rigs::hidden_effects::starting_point;
use truth_rigs::second_rig::campaign_writer::campaign;
use truth_rigs::second_rig::draw::{Kind, Wish, draw};
use truth_rigs::second_rig::manoeuvres::Plan;
use truth_rigs::second_rig::test_stand::Family;

/// First seed of the drawn campaigns.
const SEED: u64 = 9001;

/// Share by which an error may grow where the cost does not: the cost is robust, and the error counts each sample.
const ROUGHLY: f64 = 0.02;

/// A time limit that is shorter than the searches, the largest excess over it as a share of it, and what a machine adds that other
/// tests share.
const LIMIT: Duration = Duration::from_secs(8);
const EXCESS: f64 = 0.1;
const SHARED: Duration = Duration::from_secs(2);

/// A drawn campaign with two hidden effects, or physics outside the catalogue.
fn drawn(seed: u64) -> (Family, Experiment) {
    let family = if seed.is_multiple_of(2) {
        Family::Steady
    } else {
        Family::Dynamic
    };
    let wish = Wish {
        family,
        plan: Plan::Lab,
        fidelity: None,
        rough: None,
        kind: Some(if seed.is_multiple_of(3) {
            Kind::Outside
        } else {
            Kind::Pair
        }),
        effect: None,
        known: |id| hitch_effects::find(id).is_some(),
    };
    let experiment = Experiment::new(&campaign(&draw(seed, &wish)), &starting_point(family));
    (family, experiment)
}

/// The explanation of a campaign within a limit, and the intermediate results that the search reported.
fn explained(family: Family, experiment: &Experiment, limit: Limit<'_>) -> (Explanation, Vec<Fit>) {
    let accounts = Mutex::new(Vec::new());
    let options = Options {
        improved: &|fit: &Fit| accounts.lock().unwrap().push(fit.clone()),
        limit,
        ..Options::default()
    };
    let model = starting_point(family);
    let found = explain_with(Problem::new(experiment, &model), options, &|_| {});
    (found, accounts.into_inner().unwrap())
}

fn ids(fit: &Fit) -> Vec<&'static str> {
    let effects = fit.estimate.effects.iter();
    effects.map(|added| added.effect.id()).collect()
}

/// An account may have a smaller error by effects that are rather absent than present; the answer lists those. No other account
/// has an error that is smaller by more than the difference of the two measures, cost and error.
#[test]
fn the_answer_is_no_worse_than_an_account_on_the_way() {
    for seed in SEED..SEED + cases(3, 40) {
        let (family, experiment) = drawn(seed);
        let (found, accounts) = explained(family, &experiment, Limit::default());
        let doubtful: Vec<&str> = found.doubtful.iter().map(|step| step.effect.id()).collect();
        let answer = found.after.error();
        println!(
            "seed {seed}: {answer:.3} with {:?}, doubtful {doubtful:?}",
            ids(&found.after)
        );
        assert!(
            !accounts.is_empty() || found.steps.is_empty(),
            "seed {seed}: no account"
        );
        for account in accounts {
            let members = ids(&account);
            println!("  seen {:.3} with {members:?}", account.error());
            let excused = members.iter().any(|id| doubtful.contains(id));
            assert!(
                excused || answer <= (1.0 + ROUGHLY) * account.error(),
                "seed {seed}: {members:?} had {:.3}, the answer has {answer:.3}",
                account.error()
            );
        }
    }
}

#[test]
fn an_explanation_ends_with_its_time() {
    for seed in SEED..SEED + cases(2, 20) {
        let (family, experiment) = drawn(seed);
        let start = Instant::now();
        let limit = Limit {
            deadline: Some(start + LIMIT),
            requested: None,
        };
        let (found, _) = explained(family, &experiment, limit);
        let took = start.elapsed();
        println!(
            "seed {seed}: {took:.2?} of {LIMIT:?}, unfinished {}",
            found.unfinished
        );
        assert!(took <= LIMIT.mul_f64(1.0 + EXCESS) + SHARED, "seed {seed}");
    }
}
