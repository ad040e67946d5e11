//! Tests with running ECUs, emulators, servers and browsers, some of them in real time. `cargo xtask test` provides the
//! images, the emulator and the browser that the ignored ones need.

mod board_bench;
mod browser;
mod bus_in_browser;
mod bus_intruders;
#[cfg(unix)]
mod bus_page;
mod closed_loop_page;
mod corrected_constants;
mod ecu_page;
#[cfg(target_os = "linux")]
mod ecu_process;
mod ecu_tools;
mod emulated;
mod emulated_ecu;
mod field_in_browser;
mod files_in_browser;
mod fixed_parameter;
mod instrument_in_browser;
mod next_in_browser;
mod overlay_in_browser;
mod page_in_browser;
mod panics;
mod python_clients;
mod report_in_browser;
mod running_ecu;
mod second_in_browser;
mod second_model;
#[cfg(unix)]
mod serial_adapter;
mod serve;
mod try_page_in_browser;
mod upload;
mod way_in_browser;
