//! The search for the set of effects: dictionary, best subsets, refits.

pub(crate) mod best_subset;
pub mod candidates;
pub(crate) mod coarse;
pub(crate) mod delays;
pub(crate) mod dictionary;
pub(crate) mod entry;
pub(crate) mod gram;
pub(crate) mod limits;
pub(crate) mod line_search;
pub(crate) mod projections;
pub(crate) mod promise;
pub(crate) mod refit;
pub(crate) mod rivals;
pub mod scan_cache;
pub(crate) mod screen;
pub(crate) mod secant_ends;
pub(crate) mod shape_starts;
pub mod single;
pub(crate) mod size_scan;
pub mod subset;
