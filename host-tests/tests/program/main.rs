//! Tests of the program and of its interfaces to other tools.

mod adopt;
mod appearance;
mod bad_input;
mod bad_output;
mod binary_logs;
mod cli;
mod controller_stdio;
mod examples;
mod fit_report;
mod fleet;
mod fmu;
mod fmu_export;
mod fmu_states;
mod from_bus_to_model;
mod import;
mod json_schema;
mod loop_scenarios;
mod next_folder;
mod other_valves;
mod schema;
mod shell;
mod simulate;
mod small_campaign;
mod tune;
mod your_own_hitch;
