//! Model selection: evidence, hold-out, complexity penalty, posterior probability.

pub mod candidate;
pub(crate) mod complexity_penalty;
pub(crate) mod constants_cost;
pub(crate) mod constants_evidence;
pub(crate) mod constants_sensitivities;
pub mod evidence;
pub mod hold_out;
pub mod leave_one_out;
pub(crate) mod posterior;
