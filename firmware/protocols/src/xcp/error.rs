//! Why a command is refused.

/// Error codes of XCP, as far as this slave uses them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Refusal {
    /// Nothing was going on that could be synchronised: the answer to SYNCH.
    Synchronised = 0x00,
    /// Not while measuring.
    DaqActive = 0x11,
    /// The command isn't known.
    UnknownCommand = 0x20,
    /// The command is malformed.
    Syntax = 0x21,
    /// A parameter, or a value that is written, is outside its range. Nothing was changed.
    OutOfRange = 0x22,
    /// The place is never written.
    WriteProtected = 0x23,
    /// There is nothing at the address, or not just now.
    AccessDenied = 0x24,
    /// Tuning isn't enabled at the machine.
    AccessLocked = 0x25,
    /// There is no such page.
    PageNotValid = 0x26,
    /// The page can't be used like this.
    ModeNotValid = 0x27,
    /// There is no such segment.
    SegmentNotValid = 0x28,
    /// Commands came in the wrong order.
    Sequence = 0x29,
    /// The lists or entries don't make a measurement.
    DaqConfiguration = 0x2A,
    /// No room for more lists, tables or entries.
    MemoryOverflow = 0x30,
    /// Something in the slave failed.
    Generic = 0x31,
}
