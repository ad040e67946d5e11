//! Co-simulation units (FMUs): the shared library with its description and its content, in one archive.

mod archive;
mod library;

pub use archive::archive;
pub use library::find;
