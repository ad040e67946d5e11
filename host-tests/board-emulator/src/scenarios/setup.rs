//! What a scenario is given.

use std::path::PathBuf;

use anyhow::Result;

use crate::image::Image;
use crate::layout::Layout;

/// The image of a board, and the emulator's library.
#[derive(Clone, Debug)]
pub struct Setup {
    /// Shared library of the CPU emulator.
    pub library: PathBuf,
    /// The board.
    pub layout: Layout,
    /// Its image.
    pub image: Image,
}

/// A scenario; an error describes the failure.
pub type Scenario = fn(&Setup) -> Result<String>;
