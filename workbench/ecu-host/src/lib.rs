//! The ECU on a computer, and a computer on the bus of an ECU.
//!
//! [`ecu`] runs the firmware's application, as an image on an emulated processor or on the host, with a plant and a bus. [`xcp_tool`]
//! records from an ECU and writes its calibration, on an interface of Linux or an adapter.
#![forbid(unsafe_code)]

pub mod ecu;
pub mod xcp_tool;
