//! The firmware of an electro-hydraulic three-point hitch.
//!
//! [`control`] is the controller itself: pure, without clock, heap, I/O or floating point, and so
//! bit-identical on the ECU and on the host. Everything else in this crate carries it.
#![no_std]
#![forbid(unsafe_code)]

pub mod control;
