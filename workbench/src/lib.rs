//! Library of the program `hitch`.
//!
//! A command ([`commands`], named in [`cli`]) reads a campaign ([`import`], [`arguments`]), has it compared ([`comparison::Comparison`]),
//! explained ([`explanation::Found`]) or driven ([`closed_loop::LoopRun`], [`field_loop`], [`ecu`]), or a field fitted ([`mod@draft`]), and shows the result as text and
//! JSON ([`output::Document`]), as a file ([`report`]) or as a page ([`serve`]).
#![forbid(unsafe_code)]

pub mod arguments;
pub mod base_model;
pub mod cli;
pub mod closed_loop;
pub mod commands;
pub mod comparison;
pub mod draft;
pub mod ecu;
pub mod error;
pub mod explanation;
pub mod field_loop;
pub mod fleet_summary;
pub mod fmu_export;
pub mod import;
pub mod output;
pub mod report;
pub mod serve;
pub mod text;
pub mod tuning;
pub mod web;
pub mod xcp_tool;
