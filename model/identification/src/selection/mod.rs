//! What speaks for a set of effects: evidence, hold-out, price, probability.

pub mod candidate;
pub mod evidence;
pub mod hold_out;
pub mod leave_one_out;
pub(crate) mod penalty;
pub(crate) mod posterior;
