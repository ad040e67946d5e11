//! States of Tractor Implement Management (AEF 023, D.2.2 and C.2).

/// Automation status of a function, 4 bits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Automation {
    /// Remote control is not offered, or the hitch is locked.
    #[default]
    Unavailable = 0x0,
    /// No authenticated client.
    NotReady = 0x1,
    /// Authenticated, but not assigned.
    ReadyToEnable = 0x2,
    /// Assigned; the operator's consent is missing.
    Enabled = 0x3,
    /// The operator has consented.
    Pending = 0x4,
    /// Commanded by the client.
    Active = 0x5,
    /// As before; only lower values act.
    ActiveLimitedHigh = 0x6,
    /// As before; only higher values act.
    ActiveLimitedLow = 0x7,
    /// A fault.
    Fault = 0xD,
}

impl Automation {
    /// State of the server, whose values are fewer.
    #[must_use]
    pub const fn of_server(self) -> u8 {
        match self {
            Self::Unavailable | Self::Fault => self as u8,
            Self::NotReady | Self::ReadyToEnable => Self::NotReady as u8,
            Self::Enabled | Self::Pending => Self::Enabled as u8,
            Self::Active | Self::ActiveLimitedHigh | Self::ActiveLimitedLow => Self::Active as u8,
        }
    }

    /// Whether the client commands the function.
    #[must_use]
    pub const fn is_active(self) -> bool {
        self.of_server() == Self::Active as u8
    }
}

/// State of the tractor in the status of a lead server, 4 bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Operation {
    /// The requirements of the others are not fulfilled.
    NotFulfilled = 0,
    /// Driving, the operator is present.
    Normal = 1,
    /// Standing, the operator is present.
    Standstill = 2,
    /// Standing, in the mode that the operator has chosen.
    Stationary = 3,
}
