//! A second rig that measures campaigns whose hidden physics is known.
//!
//! Nothing here is the model crate's plant: the equations are written a second time from the rig's data sheet and the
//! catalogue's literature, move in finer steps, and may have structure that no fitted model has. Only the format of a
//! campaign is shared.
//!
//! ```text
//! draw           a seed -> family, plan, hidden effects, instruments
//! foreign        a machine that differs from the data sheet in many ways, and its changes
//! hideable       every physics that can be hidden, with its usual sizes; fills a `Physics`
//! physics        what a rig has beyond its data sheet, as plain numbers
//! manoeuvres     what the lab and the field do: loads, temperatures, courses of the currents
//! current_path   coil current -> spool            hydraulics   spools and pressure -> flows
//! linkage        travel -> angle, height          mechanics    forces and motion
//! test_stand     one run, sample by sample        instruments  noise, gaps, rounding
//! driven_hitch   a hitch whose currents are told a millisecond at a time, for closing a loop around it
//! on_order       runs that a design of experiments asks for
//! campaign_writer  the campaign in memory or in a folder
//! ```

pub mod angle_sensor;
pub mod campaign_writer;
pub mod current_path;
pub mod data_sheet;
pub mod draw;
pub mod driven_hitch;
pub mod foreign;
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
