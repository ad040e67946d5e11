//! Checks of the reports of `hitch`.

/// Start of the plotting library's element.
const LIBRARY: &str = "<script id=\"plotly\">";

/// End of each script.
const END: &str = "</script>";

/// The text of a report without the plotting library, whose own text has addresses that it does not load.
///
/// # Panics
/// If the library is not embedded exactly once.
#[must_use]
pub fn without_library(html: &str) -> String {
    assert_eq!(html.matches(LIBRARY).count(), 1, "one library");
    let (before, rest) = html.split_once(LIBRARY).expect("a library");
    let (library, after) = rest.split_once(END).expect("its end");
    assert!(library.len() > 1_000_000 && library.contains("plotly.js"));
    format!("{before}{after}")
}

/// The data of the plots of a report, in its order.
///
/// # Panics
/// If an element is not JSON.
#[must_use]
pub fn plots(html: &str) -> Vec<serde_json::Value> {
    let own = without_library(html);
    let elements = own.split("<script type=\"application/json\">").skip(1);
    elements
        .map(|text| {
            let (text, _) = text.split_once(END).expect("the end of an element");
            serde_json::from_str(text).expect("JSON")
        })
        .collect()
}

/// The samples of a column of a plot; NaN where missing.
///
/// # Panics
/// If it is not a column.
#[must_use]
pub fn samples(column: &serde_json::Value) -> Vec<f64> {
    let step = column["step"].as_f64().expect("a step");
    let text = column["differences"].as_str().expect("differences");
    let digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let (mut sum, mut number, mut shift) = (0_i64, 0_i64, 0);
    let sample = |letter: char| {
        if letter == '-' {
            return Some(f64::NAN);
        }
        let digit = digits.find(letter).expect("a digit of base 64") as i64;
        number |= (digit & 31) << shift;
        shift += 5;
        if digit > 31 {
            return None;
        }
        sum += if number & 1 == 1 {
            -(number >> 1)
        } else {
            number >> 1
        };
        (number, shift) = (0, 0);
        Some(step * sum as f64)
    };
    text.chars().filter_map(sample).collect()
}

/// Checks that a report loads nothing, so that it opens offline: it forbids the browser to load anything, and has no
/// reference to anything outside.
///
/// # Panics
/// If it does.
pub fn assert_self_contained(html: &str) {
    assert!(html.starts_with("<!DOCTYPE html>") && html.ends_with("</html>"));
    assert!(html.contains("<svg"));
    let (head, _) = html.split_once("</head>").expect("a head");
    assert!(head.contains("http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "));
    let own = without_library(html);
    for reference in [
        "http:",
        "https:",
        " src=",
        " href=",
        "@import",
        "url(",
        "import(",
        "fetch(",
        "\nimport ",
    ] {
        assert!(!own.contains(reference), "{reference}");
    }
}
