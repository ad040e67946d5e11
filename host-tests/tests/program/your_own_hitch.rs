//! The commands of docs/your-own-hitch.md, word by word: from data sheets and the files of two loggers to an answer.

use std::fs;
use std::path::Path;
use std::time::Instant;

use host_tests::program::run;
use truth_rigs::category_three::files::write;
use truth_rigs::category_three::machine::{
    BAR, BORE_MM, BULK_MODULUS_PA, DEAD_WEIGHT_KG, MARGIN_PA, PUMP_FLOW_LPM, PUMP_RESPONSE_S,
    VISCOUS_N_S_M, WORN_LPM_BAR,
};

/// Command of the document that writes the files of the machine; the test calls its function.
const GENERATOR: &str =
    "cargo run --release -p host-tests --example second_machine -- --out machine";

/// Commands of the document, in order; a line that ends in a backslash goes on.
fn commands(document: &str) -> Vec<String> {
    let mut found = Vec::new();
    let blocks = document.split("```console\n").skip(1);
    for block in blocks.filter_map(|block| block.split("```").next()) {
        let joined = block.replace("\\\n", " ");
        let lines = joined.lines().filter_map(|line| line.strip_prefix("$ "));
        found.extend(lines.map(|line| line.split_whitespace().collect::<Vec<_>>().join(" ")));
    }
    found
}

fn json(folder: &Path, arguments: &[&str]) -> serde_json::Value {
    let output = run(folder, arguments);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {said}");
    serde_json::from_slice(&output.stdout).unwrap()
}

fn error_of(folder: &Path, campaign: &str, model: &str) -> f64 {
    let arguments = ["compare", campaign, "--model", model, "--json", "-"];
    json(folder, &arguments)["error"].as_f64().unwrap()
}

/// Value of a key in a model file.
fn value(text: &str, key: &str) -> f64 {
    let line = text.lines().find(|line| line.starts_with(key));
    let line = line.unwrap_or_else(|| panic!("{key} in {text}"));
    line.split_once('=').unwrap().1.trim().parse().unwrap()
}

#[test]
fn the_documents_commands_find_what_is_hidden_in_a_second_machine() {
    let dir = tempfile::tempdir().unwrap();
    let folder = dir.path();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let document = root.join("docs/your-own-hitch.md");
    let commands = commands(&fs::read_to_string(document).unwrap());
    assert!(commands.len() >= 9, "{commands:?}");
    for command in &commands {
        let start = Instant::now();
        if command == GENERATOR {
            write(&folder.join("machine")).unwrap();
            continue;
        }
        let words: Vec<&str> = command.split(' ').collect();
        assert_eq!(words[0], "hitch", "{command}");
        let output = run(folder, &words[1..]);
        let [said, faults] =
            [output.stdout, output.stderr].map(|text| String::from_utf8(text).unwrap());
        println!(
            "$ {command}\n{said}{faults}[{:.1} s]\n",
            start.elapsed().as_secs_f64()
        );
        assert!(output.status.success(), "{command}: {faults}");
    }
    let [sheet, fitted] =
        ["sheet.toml", "fitted.toml"].map(|model| error_of(folder, "commissioning", model));
    let [before, after] =
        ["fitted.toml", "explained.toml"].map(|model| error_of(folder, "season", model));
    println!("error {sheet:.2} -> {fitted:.2}; after a season {before:.2} -> {after:.2}");
    assert!(fitted < 1.4 && fitted < 0.5 * sheet);
    assert!(after < 1.4 && after < 0.5 * before);
    let text = |name: &str| fs::read_to_string(folder.join(name)).unwrap();
    let (fitted, explained) = (text("fitted.toml"), text("explained.toml"));
    assert!(
        explained.contains("id = \"lowering-leakage\""),
        "{explained}"
    );
    let effects = explained.matches("id = \"").count();
    assert_eq!(effects, 1, "only the leakage is named: {explained}");
    let leakage = value(&explained, "conductance_lpm_per_bar");
    assert!((leakage / WORN_LPM_BAR - 1.0).abs() < 0.05, "{leakage}");
    for (key, machine, tolerance) in [
        ("theoretical_flow_lpm", PUMP_FLOW_LPM, 0.01),
        ("bore_mm", BORE_MM, 0.005),
        ("margin_bar", MARGIN_PA / BAR, 0.005),
        ("response_time_ms", 1e3 * PUMP_RESPONSE_S, 0.01),
        ("bulk_modulus_pa", BULK_MODULUS_PA, 0.005),
        ("viscous_friction_n_s_m", VISCOUS_N_S_M, 0.01),
        ("dead_weight_kg", DEAD_WEIGHT_KG, 0.02),
    ] {
        let found = value(&fitted, key);
        assert!((found / machine - 1.0).abs() < tolerance, "{key}: {found}");
    }
    // The valves of this machine end at 1.6 A.
    let limit_a = value(&text("map.toml"), "lift_current_limit_a");
    assert!((limit_a - 1.6).abs() < 0.02, "{limit_a} A");
    assert!(folder.join("tuned.toml").is_file() && folder.join("plant.fmu").is_file());
}
