//! Records the closed loop anew: only after the inputs of the controller got another layout, or the script changed.

use anyhow::Result;
use host_tests::{recording, trace};

fn main() -> Result<()> {
    let recorded = recording::record();
    let packed = trace::pack(&recorded);
    std::fs::write(trace::recorded_path(), &packed)?;
    println!(
        "{}: {} steps in {} bytes",
        trace::recorded_path().display(),
        recorded.len(),
        packed.len()
    );
    Ok(())
}
