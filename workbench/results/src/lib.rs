//! The results of the program `hitch`, as text, JSON and reports.
//!
//! A campaign ([`import`], [`arguments`]) is compared ([`comparison::Comparison`]), explained ([`explanation::Found`]) or a model of it
//! driven ([`closed_loop::LoopRun`], [`field_loop`]), or a field fitted ([`mod@draft`]). [`report`] writes results as files, with the scripts of
//! [`web`], which the page has as well.
#![forbid(unsafe_code)]

pub mod arguments;
pub mod base_model;
pub mod closed_loop;
pub mod comparison;
pub mod draft;
pub mod explanation;
pub mod field_loop;
pub mod fleet_summary;
#[cfg(feature = "fmu")]
pub mod fmu_export;
pub mod import;
pub mod measurement;
pub mod report;
pub mod tuning;
pub mod web;
