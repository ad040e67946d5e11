//! Builds the images for the ECU: the compilers for other targets, and how cargo is started with them.

pub mod images;
pub mod process;
pub mod programs;
pub mod setup;
pub mod toolchain;
pub mod workspace;
