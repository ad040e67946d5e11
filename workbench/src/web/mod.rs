//! Files that the page of `hitch serve` and the reports share, and the plotting library.
mod bundle;

use std::sync::OnceLock;

pub use bundle::bundle;

/// The tag that precedes each script of the plotting library.
const TAG: &str = "<script type=\"text/javascript\">";
const END_TAG: &str = "</script>";

/// The colours, of the light and the dark theme.
pub const COLOURS: &str = include_str!("colours.css");

/// Name and text of each shared module, in the order of their imports.
pub const MODULES: [(&str, &str); 3] = [
    ("dom.js", include_str!("dom.js")),
    ("error_map.js", include_str!("error_map.js")),
    ("run_plot.js", include_str!("run_plot.js")),
];

/// The plotting library without the formula renderer that its crate includes.
pub fn plotly() -> &'static str {
    static PLOTLY: OnceLock<String> = OnceLock::new();
    let script = || {
        let both = plotly::Plot::offline_js_sources();
        let first = both
            .rsplit_once(TAG)
            .map_or(both.as_str(), |(first, _)| first);
        let inner = first.trim().trim_start_matches(TAG);
        inner.trim_end_matches(END_TAG).to_owned()
    };
    PLOTLY.get_or_init(script)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_plotting_library_is_one_script() {
        let script = plotly();
        assert!(script.starts_with("/**\n* plotly.js v"));
        assert!(script.contains("Licensed under the MIT license"));
        assert!(!script.contains(TAG) && !script.contains("MathJax.js"));
        assert!(script.len() > 1_000_000);
    }

    #[test]
    fn no_script_ends_the_element_that_it_is_embedded_in() {
        let modules = MODULES.map(|(_, text)| text);
        for script in modules.into_iter().chain([plotly()]) {
            assert!(!script.contains("</script") && !script.contains("<!--"));
        }
    }
}
