//! Common parts of the tests across the crates; see `tests/`.

pub mod ecu_day;
pub mod emulator;
pub mod german_log;
pub mod html_report;
pub mod instruction_counts;
pub mod live_ecu;
pub mod loop_tab;
pub mod markdown;
pub mod page_server;
pub mod program;
pub mod python;
pub mod recording;
pub mod refusal;
pub mod replay;
pub mod seeds;
pub mod short_moves;
pub mod teaching;

pub use paired_replay::trace;
