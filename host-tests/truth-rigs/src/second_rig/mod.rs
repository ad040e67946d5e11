//! A second rig that measures campaigns whose hidden physics is known.
//!
//! This rig does not use the model crate's plant: its equations are an independent implementation from the data sheet
//! and the literature, with finer steps and optional structure that no fitted model has. Only the format of a
//! campaign is shared.
//!
//! ```text
//! draw           a seed -> family, plan, hidden effects, instruments
//! foreign        a machine that differs from the data sheet in many ways, and its changes
//! hidden         a physics that can be hidden, and its drawn shape
//! hideable       every physics that can be hidden, with its usual sizes; fills a `Physics`
//! physics        deviations of a rig from its data sheet, as plain numbers manoeuvres     lab and field plans: loads,
//! temperatures, current traces
//! current_path   coil current -> spool            hydraulics   spools and pressure -> flows
//! linkage        travel -> angle, height          mechanics    forces and motion
//! test_stand     one run, sample by sample        instruments  noise, gaps, rounding
//! driven_hitch   a hitch with currents set each millisecond, for a closed loop on_order       runs requested by a
//! design of experiments
//! campaign_writer  the campaign in memory or in a folder
//! ```

pub mod angle_sensor;
pub mod campaign_writer;
pub mod current_path;
pub mod data_sheet;
pub mod draw;
pub mod driven_hitch;
pub mod foreign;
pub mod hidden;
pub mod hideable;
pub mod hydraulics;
pub mod instruments;
pub mod linkage;
pub mod manoeuvres;
pub mod mechanics;
pub mod on_order;
pub mod outside;
pub mod physics;
pub mod test_stand;
pub mod wish_arguments;
