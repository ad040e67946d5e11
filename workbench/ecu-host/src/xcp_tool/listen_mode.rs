//! How an adapter listens.

/// Behaviour of the adapter while it listens.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ListenMode {
    /// It does not act on the bus.
    ListenOnly,
    /// It acknowledges frames, as it has no other mode.
    Acknowledging,
    /// As the administrator has configured the interface.
    AsConfigured,
}
