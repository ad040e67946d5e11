//! How long an adapter is waited for.

use std::io;
use std::time::Duration;

/// Timeout of one read, after which the deadline is checked.
pub(super) const PATIENCE: Duration = Duration::from_millis(20);

/// Timeout for sending a frame: an adapter that takes longer is stuck.
pub(super) const SENDS_WITHIN: Duration = Duration::from_secs(1);

/// Whether the operation only took too long.
pub(super) fn is_timeout(error: &io::Error) -> bool {
    matches!(
        error.kind(),
        io::ErrorKind::WouldBlock | io::ErrorKind::TimedOut | io::ErrorKind::Interrupted
    )
}
