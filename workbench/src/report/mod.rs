//! Reports: self-contained HTML files that need no network. Without scripts, and in print, they show static pictures and
//! tables; on a screen, the plots of the page of `hitch serve`.
pub mod changes_page;
pub mod chart;
mod columns;
pub mod comparison_page;
mod data;
pub mod diagnosis_page;
mod drawn;
mod envelope;
pub mod error_map;
pub mod explanation_page;
pub mod field_page;
pub mod fit_page;
pub mod loop_page;
pub mod main_page;
pub mod map_view;
pub mod page;
mod plotted;
pub mod rebuild_page;
mod rest_figure;
pub mod run_view;
pub mod run_views;
pub mod runs;
mod same_move;
pub mod scale;
pub mod staircase;
pub mod tuning_page;
pub mod variants_page;
