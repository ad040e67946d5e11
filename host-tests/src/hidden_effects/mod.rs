//! Benchmark of the identification: methods answer for cases of the [second rig](crate::second_rig), and are graded.

pub mod answer;
pub mod detectability;
pub mod explaining;
pub mod foreign;
pub mod gaussian_process;
pub mod grade;
pub mod information_criterion;
pub mod localised_hold_out;
pub mod residuals;
pub mod sparse_regression;
pub mod tally;
pub mod wrong_base;

use answer::Method;
use hitch_plant::Model;

use crate::second_rig::test_stand::Family;

/// Every method, the project's own first.
#[must_use]
pub fn methods() -> Vec<Box<dyn Method>> {
    vec![
        Box::new(explaining::Explaining),
        Box::new(information_criterion::InformationCriterion),
        Box::new(localised_hold_out::LocalisedHoldOut),
        Box::new(sparse_regression::SparseRegression),
        Box::new(gaussian_process::GaussianProcess),
    ]
}

/// The starting point that matches a family.
#[must_use]
pub fn starting_point(family: Family) -> Model {
    match family {
        Family::Steady => hitch_model_file::nominal(),
        Family::Dynamic => hitch_model_file::dynamic(),
    }
}
