//! Benchmark of the identification: it answers for cases of the [second rig](crate::second_rig), and is graded.

pub mod answer;
pub mod detectability;
pub mod explaining;
pub mod foreign;
pub mod grade;
pub mod tally;
pub mod wrong_base;

use hitch_plant::Model;

use crate::second_rig::test_stand::Family;

/// The starting point that matches a family.
#[must_use]
pub fn starting_point(family: Family) -> Model {
    match family {
        Family::Steady => hitch_model_file::nominal(),
        Family::Dynamic => hitch_model_file::dynamic(),
    }
}
