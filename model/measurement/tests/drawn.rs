//! Drawn machines with hidden effects have no fault of the measurement.

use hitch_campaign::Campaign;
use hitch_measurement::check;
use truth_rigs::hidden_effects::starting_point;
use truth_rigs::second_rig::campaign_writer::campaign;
use truth_rigs::second_rig::draw::{Wish, draw};
use truth_rigs::second_rig::manoeuvres::Plan;
use truth_rigs::second_rig::test_stand::Family;

/// At most one campaign in a hundred has a finding: none of the few by day.
#[test]
fn drawn_campaigns_have_no_finding() {
    let is_thorough = std::env::var_os("HITCH_THOROUGH").is_some();
    let seeds = if is_thorough { 100 } else { 4 };
    let mut with_findings = 0;
    for family in [Family::Steady, Family::Dynamic] {
        for plan in [Plan::Lab, Plan::Field] {
            let is_false = |seed: &u64| has_finding(*seed, family, plan);
            with_findings += (1..=seeds).filter(is_false).count();
        }
    }
    let campaigns = 4 * seeds as usize;
    println!("{with_findings} of {campaigns} campaigns have a finding");
    assert!(100 * with_findings <= campaigns);
}

/// Whether the check finds something, with the model of the data sheet, without one, or without a stated noise.
fn has_finding(seed: u64, family: Family, plan: Plan) -> bool {
    let wish = Wish {
        family,
        plan,
        fidelity: None,
        rough: None,
        kind: None,
        effect: None,
        known: |_| true,
    };
    let model = starting_point(family);
    let stated = campaign(&draw(seed, &wish));
    let mut unstated: Campaign = stated.clone();
    unstated.noise.channels = [None; 4];
    let cases = [
        (&stated, Some(&model)),
        (&stated, None),
        (&unstated, Some(&model)),
    ];
    let found = cases.map(|(campaign, model)| check(campaign, model));
    let found: Vec<_> = found.iter().flatten().collect();
    if !found.is_empty() {
        println!("{family:?} {plan:?} {seed}: {found:#?}");
    }
    !found.is_empty()
}
