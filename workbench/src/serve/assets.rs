//! The files of the page, compiled into the program.
use std::sync::OnceLock;

use axum::body::Bytes;
use axum::http::header;
use axum::response::{IntoResponse, Response};

/// The tag that precedes each script of the plotting library.
const TAG: &str = "<script type=\"text/javascript\">";
const END_TAG: &str = "</script>";

const SCRIPT: &str = "text/javascript; charset=utf-8";

/// Name, media type and text of every file except the plotting library.
const FILES: &[(&str, &str, &str)] = &[
    (
        "",
        "text/html; charset=utf-8",
        include_str!("assets/index.html"),
    ),
    (
        "page.css",
        "text/css; charset=utf-8",
        include_str!("assets/page.css"),
    ),
    ("main.js", SCRIPT, include_str!("assets/main.js")),
    ("server.js", SCRIPT, include_str!("assets/server.js")),
    ("dom.js", SCRIPT, include_str!("assets/dom.js")),
    ("error_map.js", SCRIPT, include_str!("assets/error_map.js")),
    ("own_term.js", SCRIPT, include_str!("assets/own_term.js")),
    (
        "closed_loop.js",
        SCRIPT,
        include_str!("assets/closed_loop.js"),
    ),
    (
        "loop_orders.js",
        SCRIPT,
        include_str!("assets/loop_orders.js"),
    ),
    ("linkage.js", SCRIPT, include_str!("assets/linkage.js")),
    (
        "strip_chart.js",
        SCRIPT,
        include_str!("assets/strip_chart.js"),
    ),
    ("valve_map.js", SCRIPT, include_str!("assets/valve_map.js")),
    ("missing.js", SCRIPT, include_str!("assets/missing.js")),
    (
        "model_panel.js",
        SCRIPT,
        include_str!("assets/model_panel.js"),
    ),
    ("run_plot.js", SCRIPT, include_str!("assets/run_plot.js")),
];

/// A file of the page by its name; the name of the page itself is empty.
pub fn file(name: &str) -> Option<Response> {
    let answer = |kind: &'static str, text: Bytes| ([(header::CONTENT_TYPE, kind)], text);
    if name == "plotly.js" {
        return Some(answer(SCRIPT, plotly()).into_response());
    }
    let (_, kind, text) = FILES.iter().find(|(known, ..)| *known == name)?;
    Some(answer(kind, Bytes::from_static(text.as_bytes())).into_response())
}

/// The plotting library without the formula renderer that its crate includes.
fn plotly() -> Bytes {
    static PLOTLY: OnceLock<Bytes> = OnceLock::new();
    let script = || {
        let both = plotly::Plot::offline_js_sources();
        let first = both
            .rsplit_once(TAG)
            .map_or(both.as_str(), |(first, _)| first);
        let inner = first.trim().trim_start_matches(TAG);
        Bytes::from(inner.trim_end_matches(END_TAG).to_owned())
    };
    PLOTLY.get_or_init(script).clone()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_plotting_library_is_one_script() {
        let script = String::from_utf8(plotly().to_vec()).unwrap();
        assert!(script.starts_with("/**\n* plotly.js v"));
        assert!(script.contains("Licensed under the MIT license"));
        assert!(!script.contains(TAG) && !script.contains("MathJax.js"));
        assert!(script.len() > 1_000_000);
    }

    #[test]
    fn only_known_files_are_served() {
        assert!(file("").is_some() && file("main.js").is_some());
        assert!(file("../Cargo.toml").is_none());
    }
}
