//! Reports: one HTML file each, with everything in it, that opens without a network and prints well.
pub mod chart;
pub mod comparison_page;
pub mod explanation_page;
pub mod loop_page;
pub mod main_page;
pub mod page;
pub mod rebuild_page;
mod rest_figure;
pub mod run_views;
pub mod runs;
pub mod scale;
pub mod staircase;
