//! What the thread that listens and the requests of the tabs share.

use super::heard::Heard;
use hitch_ecu_host::xcp_tool::ListenMode;

/// What the thread and the requests of the tabs share.
#[derive(Debug)]
pub struct State {
    /// The adapter, or why it is lost.
    pub adapter: Result<ListenMode, String>,
    /// What was received.
    pub heard: Heard,
}
