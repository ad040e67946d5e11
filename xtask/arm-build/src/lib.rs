//! Builds the images for the ECU: the ARM toolchain, and how cargo is started with it.

pub mod images;
pub mod process;
pub mod setup;
pub mod toolchain;
pub mod workspace;
