//! What the control part hands to the envelope.

use hitch_quantities::CoilCurrents;

/// Number of a step of the envelope: proves in which step a command was computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Step(u32);

impl Step {
    /// The step after this one.
    pub(super) const fn next(self) -> Self {
        Self(self.0.wrapping_add(1))
    }
}

/// Requested currents with the step that they were computed in ([`Envelope::step`](super::Envelope::step)). The
/// envelope takes them in this step only.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Command {
    /// The currents.
    pub currents: CoilCurrents,
    /// The step.
    pub step: Step,
}
