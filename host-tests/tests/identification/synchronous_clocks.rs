//! A channel that is delayed by a sample: with independent clocks the logger can be the cause, with synchronous clocks
//! it is the sensor.

use std::path::Path;

use hitch_campaign::Campaign;
use hitch_identification::data::experiment::Experiment;
use hitch_identification::data::problem::Problem;
use hitch_identification::explanation::explain::{Explanation, Verdict, explain};
use hitch_plant::Channel;

/// The clean campaign with its angle a sample late, explained.
fn explained(synchronous: bool) -> Explanation {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("campaigns/clean-steady");
    let mut campaign = Campaign::load(&folder).expect("a campaign");
    campaign.synchronous = synchronous;
    for run in &mut campaign.runs {
        if let Some(angle_deg) = &mut run.channels[Channel::RockerAngle.index()] {
            angle_deg.pop();
            angle_deg.insert(0, angle_deg[0]);
        }
    }
    let model = hitch_model_file::nominal();
    explain(
        Problem::new(&Experiment::new(&campaign, &model), &model),
        &|_| (),
    )
}

#[test]
fn separate_clocks_may_have_offsets() {
    let explanation = explained(false);
    assert_eq!(explanation.verdict, Verdict::NothingMissing);
    let late_s = explanation.after.estimate.clocks.offsets_s[Channel::RockerAngle.index()];
    assert!((late_s - 0.02).abs() < 0.002, "{late_s}");
}

#[test]
fn with_synchronous_clocks_a_delay_is_a_sensor_lag() {
    let explanation = explained(true);
    assert_eq!(explanation.after.estimate.clocks.offsets_s, [0.0; 4]);
    let [step] = explanation.steps.as_slice() else {
        panic!("{:?}", explanation.steps);
    };
    assert_eq!(step.effect.id(), "angle-sensor-lag");
    assert!((step.values[0] - 0.02).abs() < 0.002, "{:?}", step.values);
}
