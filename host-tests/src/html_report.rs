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
