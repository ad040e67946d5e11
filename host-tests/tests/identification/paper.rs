//! JSON output of `hitch paper`: values of the paper and of the model.
use std::sync::OnceLock;

use host_tests::program::run;
use serde_json::Value;
use tempfile::TempDir;

fn paper(model: &str) -> Value {
    let dir = TempDir::new().unwrap();
    let output = run(dir.path(), &["paper", "--model", model, "--json", "-"]);
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    serde_json::from_slice(&output.stdout).expect("one JSON document")
}

/// The nominal model's, computed once for all tests.
fn nominal() -> &'static Value {
    static NOMINAL: OnceLock<Value> = OnceLock::new();
    NOMINAL.get_or_init(|| paper("nominal"))
}

fn number(value: &Value) -> f64 {
    value
        .as_f64()
        .unwrap_or_else(|| panic!("{value} is a number"))
}

// REQ-DIAG-11
#[test]
fn table_2_comes_out_of_the_flow_bench() {
    for table in nominal()["table_2"].as_array().unwrap() {
        assert!(number(&table["largest_difference_lpm"]) < 1e-6, "{table}");
    }
}

// REQ-DIAG-11
#[test]
fn the_largest_orifice_area_is_the_paper_s() {
    let area = &nominal()["orifice_area"];
    assert_eq!(number(&area["paper_mm2"]), 51.411);
    assert!(
        (number(&area["model_mm2"]) / 51.411 - 1.0).abs() < 1e-3,
        "{area}"
    );
}

#[test]
fn table_5_is_found_by_the_identification() {
    let table = &nominal()["table_5"];
    // Whether the lift orifice is smaller or the check valve's spring stiffer no flow test can tell.
    assert_eq!(table["verdict"], "ambiguous");
    let effects = table["effects"].as_array().unwrap();
    let mut found: Vec<&str> = effects
        .iter()
        .map(|check| check["effect"].as_str().unwrap())
        .collect();
    found.sort_unstable();
    assert_eq!(
        found,
        [
            "lift-flow-scale",
            "lower-flow-scale",
            "lower-threshold-shift"
        ]
    );
    for check in effects {
        let (expected, found) = (number(&check["expected"]), number(&check["found"]["value"]));
        assert!((found / expected - 1.0).abs() < 0.02, "{check}");
    }
    let [lift, lower] = &table["valves"].as_array().unwrap()[..] else {
        panic!("two valves")
    };
    for (valve, quantity, tolerance) in [
        (lift, "saturation_lpm", 0.05),
        (lower, "saturation_lpm", 0.05),
        (lower, "threshold_a", 0.002),
    ] {
        let difference = number(&valve[quantity]["model"]) - number(&valve[quantity]["table_5"]);
        assert!(difference.abs() < tolerance, "{quantity} of {valve}");
    }
}

#[test]
fn the_check_valve_cracks_at_2_5_bar() {
    let check_valve = &nominal()["check_valve"];
    assert_eq!(number(&check_valve["model_bar"]), 2.5);
    for spring in check_valve["springs"].as_array().unwrap() {
        let area_mm2 = std::f64::consts::FRAC_PI_4 * number(&spring["port_diameter_mm"]).powi(2);
        let force_n = number(&spring["stiffness_n_mm"]) * number(&spring["compression_mm"]);
        assert!(
            (force_n / area_mm2 * 10.0 - 2.5).abs() < 1e-9,
            "equation 7, N/mm2 in bar: {spring}"
        );
    }
}

// REQ-DIAG-11
#[test]
fn figure_12_is_what_the_paper_says_of_it() {
    for (model, paper) in [("nominal", nominal()), ("dynamic", &paper("dynamic"))] {
        let figure = &paper["figure_12"];
        for statement in figure["statements"].as_array().unwrap() {
            assert_eq!(statement["holds"], true, "{model}: {statement}");
        }
        for panel in ["lifting", "lowering"] {
            let rows = figure[panel]["times_s"].as_array().unwrap();
            assert_eq!(rows.len(), 5);
            assert!(rows.iter().all(|row| row.as_array().unwrap().len() == 5));
        }
    }
}
