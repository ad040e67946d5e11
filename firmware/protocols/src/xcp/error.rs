//! Reasons for the refusal of a command.

/// Error codes of XCP that this slave uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Refusal {
    /// Nothing to synchronise: the answer to SYNCH.
    Synchronised = 0x00,
    /// Not permitted while measuring.
    DaqActive = 0x11,
    /// Unknown command.
    UnknownCommand = 0x20,
    /// Malformed command.
    Syntax = 0x21,
    /// A parameter or a written value is out of range. Nothing was changed.
    OutOfRange = 0x22,
    /// The address is read-only.
    WriteProtected = 0x23,
    /// The address is invalid, or not accessible now.
    AccessDenied = 0x24,
    /// Tuning is not enabled on the machine.
    AccessLocked = 0x25,
    /// The page does not exist.
    PageNotValid = 0x26,
    /// The page cannot be used in this mode.
    ModeNotValid = 0x27,
    /// The segment does not exist.
    SegmentNotValid = 0x28,
    /// Wrong order of commands.
    Sequence = 0x29,
    /// The lists or entries are not a valid measurement.
    DaqConfiguration = 0x2A,
    /// No room for more lists, tables or entries.
    MemoryOverflow = 0x30,
    /// Failure of the slave.
    Generic = 0x31,
}
