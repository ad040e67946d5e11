//! What a scenario is given.

use std::path::PathBuf;

use anyhow::Result;
use hitch_plant::Model;

use crate::image::Image;
use crate::layout::Layout;

/// The image of a board, the emulator's library, and the plant.
#[derive(Clone, Debug)]
pub struct Setup {
    /// Shared library of the CPU emulator.
    pub library: PathBuf,
    /// The board.
    pub layout: Layout,
    /// Its image.
    pub image: Image,
    /// The plant.
    pub model: Model,
}

/// A scenario; an error describes the failure.
pub type Scenario = fn(&Setup) -> Result<String>;
