//! What the main clock is made from.

/// What the main clock is made from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// The crystal.
    Crystal,
    /// The internal oscillator: accurate enough for reports, not for driving the coils.
    Internal,
}
