//! The search for the set of effects: dictionary, best subsets, refits.

pub mod best_subset;
pub mod candidates;
pub mod coarse;
pub mod delays;
pub mod dictionary;
pub mod entry;
pub mod gram;
pub mod limits;
pub mod line_search;
pub mod projections;
pub mod promise;
pub mod refit;
pub mod rivals;
pub mod scan_cache;
pub mod screen;
pub mod secant_ends;
pub mod shape_starts;
pub mod single;
pub mod size_scan;
pub mod subset;
