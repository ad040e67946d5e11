//! The controller of an electro-hydraulic three-point hitch.
#![no_std]
#![forbid(unsafe_code)]
