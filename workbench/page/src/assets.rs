//! The files of the page, compiled into the program.
use axum::body::Bytes;
use axum::http::header;
use axum::response::{IntoResponse, Response};
use include_dir::{Dir, include_dir};

use hitch_results::web;

const SCRIPT: &str = "text/javascript; charset=utf-8";

/// Caching of the plotting library, for reloads of the page. The token in its address changes with each start of the program.
const KEPT: &str = "private, max-age=86400, immutable";

/// Every file that the page does not share; `index.html` is the page itself.
static FILES: Dir<'_> = include_dir!("$CARGO_MANIFEST_DIR/src/assets");

/// The text of a script, a style sheet or, with an empty name, of the page itself; `None` for any other name. The plotting library
/// and the colours are those of [`web`].
#[must_use]
pub fn page_text(name: &str) -> Option<&'static str> {
    let shared = web::MODULES.into_iter().find(|(known, _)| *known == name);
    let own = || FILES.get_file(if name.is_empty() { "index.html" } else { name });
    let text = shared.map(|(_, text)| text);
    text.or_else(|| own()?.contents_utf8())
}

/// A file of the page by its name; the name of the page itself is empty.
pub fn file(name: &str) -> Option<Response> {
    let answer = |kind, text: &'static str| {
        let text = Bytes::from_static(text.as_bytes());
        ([(header::CONTENT_TYPE, kind)], text)
    };
    if name == "plotly.js" {
        let library = answer(SCRIPT, web::PLOTLY);
        return Some(([(header::CACHE_CONTROL, KEPT)], library).into_response());
    }
    let text = match name {
        "colours.css" => web::COLOURS,
        _ => page_text(name)?,
    };
    let kind = match name.rsplit_once('.') {
        Some((_, "js")) => SCRIPT,
        Some((_, "css")) => "text/css; charset=utf-8",
        _ => "text/html; charset=utf-8",
    };
    Some(answer(kind, text).into_response())
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
        let page = page_text("").unwrap();
        let names = FILES.files().filter_map(|file| file.path().to_str());
        let imported = names.filter(|name| name.ends_with(".js") && *name != "main.js");
        for name in imported.chain(web::MODULES.iter().map(|(name, _)| *name)) {
            let preload = format!("<link rel=\"modulepreload\" href=\"{name}\">");
            assert!(page.contains(&preload), "{name}");
        }
    }
}
