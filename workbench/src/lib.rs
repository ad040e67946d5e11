//! Library of the program `hitch`.
#![forbid(unsafe_code)]

pub mod base_fit;
pub mod baseline_arg;
pub mod calibrate;
pub mod cli;
pub mod closed_loop;
pub mod commands;
pub mod comparison;
pub mod demonstration;
pub mod ecu;
pub mod effect_arg;
pub mod error;
pub mod explanation;
pub mod field_loop;
pub mod fmu_export;
pub mod heat_table;
pub mod import;
pub mod input_stream;
pub mod interruption;
pub mod model_arg;
pub mod next_command;
pub mod output;
pub mod outputs;
pub mod paper;
pub mod progress;
pub mod rebuild;
pub mod report;
pub mod search_args;
pub mod serve;
pub mod slcan_server;
pub mod status_line;
pub mod text;
pub mod tuning;
pub mod valve_survey;
pub mod web;
pub mod xcp_tool;
