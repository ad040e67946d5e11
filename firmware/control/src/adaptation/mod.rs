//! What moves teach about this machine, kept until the supply goes.

pub mod learning;
pub mod offset;
