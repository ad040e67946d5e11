//! The search for the set of effects: dictionary, best subsets, refits.

pub(crate) mod best_subset;
pub mod candidates;
pub(crate) mod coarse_view;
pub(crate) mod confounded;
pub(crate) mod dictionary;
pub(crate) mod dictionary_entry;
pub(crate) mod line_search;
pub mod options;
pub(crate) mod projections;
pub(crate) mod promising_subsets;
pub(crate) mod refit;
pub(crate) mod resolution;
pub(crate) mod screening;
pub(crate) mod secant_ends;
pub(crate) mod shape_starts;
pub mod single_effects;
pub(crate) mod size_grid;
pub(crate) mod size_scan;
pub mod subset;
