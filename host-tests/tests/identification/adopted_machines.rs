//! Machines with structures of their own, adopted from a data sheet that is off in every constant.

use host_tests::seeds::cases;
use truth_rigs::hidden_effects::foreign::Adopted;
use truth_rigs::second_rig::manoeuvres::Plan;
use truth_rigs::second_rig::test_stand::Family;

/// Seeds of machines, by day and by night. In 101 one run ends just above the ground, so that the cost steps with the ground's
/// height; in 109 the error that remains at first speaks against the compensator's lag, which is there.
const BY_DAY: &[u64] = &[101];
const BY_NIGHT: &[u64] = &[101, 103, 106, 107, 109];

/// Largest error of an adopted model, in sigmas: the median that was asked for.
const ERROR: f64 = 1.05;

#[test]
fn an_adopted_model_is_as_good_as_the_instruments() {
    for &seed in cases(BY_DAY, BY_NIGHT) {
        let adopted = Adopted::new(seed, Family::Steady, Plan::Lab);
        let named = adopted.model.effects.iter().map(|added| added.effect.id());
        println!(
            "machine {seed}: {:?}, adopted {:?}, error {:.3}, {:.1} s",
            adopted.foreign.own,
            named.collect::<Vec<_>>(),
            adopted.error,
            adopted.seconds
        );
        assert!(adopted.error < ERROR, "machine {seed}");
    }
}
