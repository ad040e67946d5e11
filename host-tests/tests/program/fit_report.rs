//! The report of `hitch model fit`.

use std::fs;

use host_tests::html_report::{assert_self_contained, plots, samples, without_library};
use host_tests::program::run;
use serde_json::Value;

use super::small_campaign::campaign;

/// Resolution of the drawn values relative to their extent, rounded up to a power of ten.
const DRAWN: f64 = 1e-3;

fn json(arguments: &[&str], folder: &std::path::Path) -> Value {
    let output = run(folder, arguments);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    serde_json::from_slice(&output.stdout).unwrap()
}

fn number(of: &Value, key: &str) -> f64 {
    of[key].as_f64().unwrap_or(f64::NAN)
}

/// The line of a plot with this name.
fn line<'a>(plot: &'a Value, name: &str) -> Option<&'a Value> {
    let mut lines = plot["rows"][0]["lines"].as_array()?.iter();
    lines.find(|line| line["name"] == name)
}

/// The drawn intervals are those of the document: low, high, and a gap after each.
fn assert_intervals(plot: &Value, points: &[&Value]) {
    for (name, determined) in [("95 % interval", true), ("not determined, 95 %", false)] {
        let own: Vec<&&Value> = points
            .iter()
            .filter(|point| point["determined"] == determined)
            .collect();
        let drawn = line(plot, name).map_or(Vec::new(), |line| samples(&line["y"]));
        assert_eq!(drawn.len(), 3 * own.len(), "{name}");
        for (bar, point) in drawn.chunks(3).zip(own) {
            let ends = [number(point, "low_lpm"), number(point, "high_lpm")];
            let far = |(drawn, told): (&f64, &f64)| (drawn - told).abs() > DRAWN * ends[1].max(1.0);
            assert!(!bar.iter().zip(&ends).any(far), "{bar:?} {point}");
            assert!(bar[2].is_nan());
        }
    }
}

#[test]
fn the_report_of_a_fit_has_the_curves_constants_and_runs_before_and_after() {
    let dir = campaign();
    let arguments = [
        "model", "fit", ".", "--model", "nominal", "--out", "f.toml", "--report", "f.html",
        "--json", "-",
    ];
    let document = json(&arguments, dir.path());
    let html = fs::read_to_string(dir.path().join("f.html")).unwrap();
    assert_self_contained(&html);
    let plots = plots(&html);
    let curves = document["curves"].as_array().unwrap();
    for (valve, title) in [
        ("lift_valve", "Lift valve"),
        ("lower_valve", "Lowering valve"),
    ] {
        let points: Vec<&Value> = curves
            .iter()
            .filter(|point| point["valve"] == valve)
            .collect();
        let is_own = |plot: &&Value| {
            let title_of = plot["rows"][0]["title"].as_str();
            title_of.is_some_and(|of| of.starts_with(title))
        };
        let plot = plots.iter().find(is_own).expect(title);
        for (name, key) in [("declared", "declared_lpm"), ("fitted", "fitted_lpm")] {
            let drawn = samples(&line(plot, name).unwrap()["y"]);
            let told: Vec<f64> = points.iter().map(|point| number(point, key)).collect();
            let open = &drawn[drawn.len() - told.len()..];
            let far = |(drawn, told): (&f64, &f64)| (drawn - told).abs() > DRAWN * told.max(1.0);
            assert!(
                !open.iter().zip(&told).any(far),
                "{name}: {open:?} {told:?}"
            );
        }
        assert_intervals(plot, &points);
    }
    let own = without_library(&html);
    for constant in document["constants"].as_array().unwrap() {
        let name = constant["name"].as_str().unwrap();
        assert!(
            own.contains(&format!("<th scope=\"row\">{name}</th>")),
            "{name}"
        );
        assert!(number(constant, "tolerance") > 0.0, "{constant}");
    }
    let run = plots
        .iter()
        .find(|plot| plot["channels"].is_array())
        .unwrap();
    assert_eq!(run["names"]["simulated"], "model after");
    let mut channels = run["channels"].as_array().unwrap().iter();
    assert!(channels.any(|channel| channel["first"] != channel["simulated"]));
}
