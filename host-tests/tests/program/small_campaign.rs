//! A campaign for tests that has to be quick.

use std::fs;
use std::path::PathBuf;

use tempfile::TempDir;

/// The campaign that comes with the program, reduced to four short runs.
pub fn campaign() -> TempDir {
    let shipped = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../workbench/data/demonstration");
    let dir = TempDir::new().unwrap();
    let manifest = fs::read_to_string(shipped.join("campaign.toml")).unwrap();
    let (head, runs) = manifest.split_once("[[run]]").unwrap();
    let kept = [
        "flow_lower_005bar",
        "flow_lower_040bar",
        "lower_2.2A_150kg",
        "lower_2.2A_250kg",
    ];
    let runs = runs
        .split("[[run]]")
        .filter(|run| kept.iter().any(|name| run.contains(name)));
    let runs: String = runs.map(|run| format!("[[run]]{run}")).collect();
    fs::write(dir.path().join("campaign.toml"), format!("{head}{runs}")).unwrap();
    for name in kept {
        let file = format!("{name}.csv");
        fs::copy(shipped.join(&file), dir.path().join(&file)).unwrap();
    }
    dir
}
