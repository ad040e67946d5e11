//! Records the closed loop again: only after a change of the input layout of the controller, or of the script.

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
