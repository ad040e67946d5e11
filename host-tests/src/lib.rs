//! Common parts of the tests across the crates; see `tests/`.

pub mod board;
pub mod category_three;
pub mod drawn_hitches;
pub mod ecu_day;
pub mod ecu_tool;
pub mod emulator;
pub mod frozen_angle;
pub mod german_log;
pub mod hidden_effects;
pub mod html_report;
pub mod instruction_counts;
pub mod lab;
pub mod live_ecu;
pub mod loop_tab;
pub mod page_server;
pub mod program;
pub mod python;
pub mod recording;
pub mod refusal;
pub mod replay;
pub mod second_rig;
pub mod seeds;
pub mod short_moves;
pub mod simulated_lab;
pub mod teaching;

pub use paired_replay::trace;
