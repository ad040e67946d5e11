//! The list of conditions of a step.

use hitch_quantities::Trip;
use hitch_safety::rows::Rows;

/// Conditions come from several watches: one that two of them state is stated.
#[test]
fn a_row_that_is_stated_twice_holds() {
    let rows = Rows::of([(Trip::Supply, true); Trip::ALL.len()]);
    assert!(rows.has_any(&[Trip::Supply]));
    assert!(!rows.has_any(&[Trip::AngleFrozen, Trip::BothCoils]));
}
