//! When the ECU samples.

/// Sampling event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Event {
    /// With every step of the controller.
    Every1Ms = 0,
    /// With every tenth.
    Every10Ms = 1,
    /// With every hundredth.
    Every100Ms = 2,
}

impl Event {
    /// All of them, in the order of their numbers.
    pub const ALL: [Self; 3] = [Self::Every1Ms, Self::Every10Ms, Self::Every100Ms];

    /// The event with a number.
    #[must_use]
    pub fn from_number(number: u16) -> Option<Self> {
        Self::ALL.get(usize::from(number)).copied()
    }

    /// Time between two of them, ms.
    #[must_use]
    pub const fn period_ms(self) -> u8 {
        match self {
            Self::Every1Ms => 1,
            Self::Every10Ms => 10,
            Self::Every100Ms => 100,
        }
    }
}
