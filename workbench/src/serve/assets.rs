//! The files of the page, compiled into the program.
use axum::body::Bytes;
use axum::http::header;
use axum::response::{IntoResponse, Response};

use crate::web;

const SCRIPT: &str = "text/javascript; charset=utf-8";

/// Caching of the plotting library, for reloads of the page. The token in its address changes with each start of the program.
const KEPT: &str = "private, max-age=86400, immutable";

/// Name, media type and text of every file that the page does not share.
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
    ("fault.js", SCRIPT, include_str!("assets/fault.js")),
    (
        "first_model.js",
        SCRIPT,
        include_str!("assets/first_model.js"),
    ),
    (
        "controller.js",
        SCRIPT,
        include_str!("assets/controller.js"),
    ),
    ("constants.js", SCRIPT, include_str!("assets/constants.js")),
    (
        "next_experiment.js",
        SCRIPT,
        include_str!("assets/next_experiment.js"),
    ),
    ("way.js", SCRIPT, include_str!("assets/way.js")),
    ("files.js", SCRIPT, include_str!("assets/files.js")),
    ("second.js", SCRIPT, include_str!("assets/second.js")),
    ("overlay.js", SCRIPT, include_str!("assets/overlay.js")),
    (
        "plot_cursor.js",
        SCRIPT,
        include_str!("assets/plot_cursor.js"),
    ),
    ("refused.js", SCRIPT, include_str!("assets/refused.js")),
    ("run_list.js", SCRIPT, include_str!("assets/run_list.js")),
    ("signals.js", SCRIPT, include_str!("assets/signals.js")),
    ("tabs.js", SCRIPT, include_str!("assets/tabs.js")),
    ("trial.js", SCRIPT, include_str!("assets/trial.js")),
    (
        "known_points.js",
        SCRIPT,
        include_str!("assets/known_points.js"),
    ),
    ("mapping.js", SCRIPT, include_str!("assets/mapping.js")),
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
    (
        "field_orders.js",
        SCRIPT,
        include_str!("assets/field_orders.js"),
    ),
    (
        "field_view.js",
        SCRIPT,
        include_str!("assets/field_view.js"),
    ),
    ("linkage.js", SCRIPT, include_str!("assets/linkage.js")),
    (
        "strip_chart.js",
        SCRIPT,
        include_str!("assets/strip_chart.js"),
    ),
    ("valve_map.js", SCRIPT, include_str!("assets/valve_map.js")),
    ("message.js", SCRIPT, include_str!("assets/message.js")),
    ("missing.js", SCRIPT, include_str!("assets/missing.js")),
    (
        "model_panel.js",
        SCRIPT,
        include_str!("assets/model_panel.js"),
    ),
];

/// The text of a script, a style sheet or, with an empty name, of the page itself; `None` for any other name. The plotting library
/// and the colours are those of [`web`].
#[must_use]
pub fn page_text(name: &str) -> Option<&'static str> {
    let own = FILES.iter().map(|(name, _, text)| (*name, *text));
    let mut files = own.chain(web::MODULES);
    files
        .find(|(known, _)| *known == name)
        .map(|(_, text)| text)
}

/// A file of the page by its name; the name of the page itself is empty.
pub fn file(name: &str) -> Option<Response> {
    let answer = |kind: &'static str, text: Bytes| ([(header::CONTENT_TYPE, kind)], text);
    if name == "plotly.js" {
        let answer = answer(SCRIPT, Bytes::from_static(web::PLOTLY.as_bytes()));
        return Some(([(header::CACHE_CONTROL, KEPT)], answer).into_response());
    }
    if name == "colours.css" {
        let text = Bytes::from_static(web::COLOURS.as_bytes());
        return Some(answer("text/css; charset=utf-8", text).into_response());
    }
    let shared = web::MODULES
        .iter()
        .map(|(name, text)| (*name, SCRIPT, *text));
    let mut files = FILES.iter().copied().chain(shared);
    let (_, kind, text) = files.find(|(known, ..)| *known == name)?;
    Some(answer(kind, Bytes::from_static(text.as_bytes())).into_response())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_known_files_are_served() {
        assert!(file("").is_some() && file("main.js").is_some() && file("dom.js").is_some());
        assert!(file("../Cargo.toml").is_none());
    }

    #[test]
    fn the_browser_requests_all_modules_at_once() {
        let (_, _, page) = FILES[0];
        let own = FILES.iter().filter(|(_, kind, _)| *kind == SCRIPT);
        let names = own.map(|(name, ..)| *name);
        let imported = names.filter(|name| *name != "main.js");
        for name in imported.chain(web::MODULES.iter().map(|(name, _)| *name)) {
            let preload = format!("<link rel=\"modulepreload\" href=\"{name}\">");
            assert!(page.contains(&preload), "{name}");
        }
    }
}
