//! The closed loop of `hitch serve` inside a static page: firmware, plant and calibration, compiled to WebAssembly.
//!
//! `cargo xtask try-page` builds the page. [`mod@bench`] answers the requests of its script, and [`abi`] passes their texts.
//! The closed loop is that of `hitch_closed_loop::driven`, which the server of `hitch serve` uses as well.
#![deny(unsafe_code)]

pub mod abi;
pub mod bench;
