//! Reports: self-contained HTML files that need no network and are printable.
pub mod chart;
pub mod comparison_page;
pub mod diagnosis_page;
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
