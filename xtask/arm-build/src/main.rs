//! Builds the image for the emulator. The last line of the output is its path.

use anyhow::Result;
use arm_build::toolchain::ARM;
use arm_build::{images, setup};

fn main() -> Result<()> {
    let image = images::build_emulated(setup::toolchain(None, ARM)?)?;
    println!("{}", image.display());
    Ok(())
}
