//! What the sensors say, judged.

pub mod sensors;
