//! Files that the page of `hitch serve` and the reports share, and the plotting library.
mod bundle;
pub mod heat_table;
pub mod plot;

pub use bundle::bundle;

/// The colours, of the light and the dark theme.
pub const COLOURS: &str = include_str!("colours.css");

/// Name and text of each shared module, in the order of their imports.
pub const MODULES: [(&str, &str); 3] = [
    ("dom.js", include_str!("dom.js")),
    ("error_map.js", include_str!("error_map.js")),
    ("run_plot.js", include_str!("run_plot.js")),
];

/// The plotting library, plotly.js (MIT): its basic bundle, which has the line plots and a quarter of the size of the whole.
///
/// It is the file of the npm package `plotly.js-basic-dist-min`. The crate `plotly` contains the whole library, but adds a
/// minute of compilation and 43 packages.
pub const PLOTLY: &str = include_str!("../../../vendor/plotly/plotly-basic.min.js");

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_plotting_library_is_one_script() {
        assert!(PLOTLY.starts_with("/**\n* plotly.js (basic - minified) v"));
        assert!(PLOTLY.contains("Licensed under the MIT license"));
        assert!(PLOTLY.len() > 1_000_000);
    }

    #[test]
    fn no_script_ends_the_element_that_it_is_embedded_in() {
        let modules = MODULES.map(|(_, text)| text);
        for script in modules.into_iter().chain([PLOTLY]) {
            assert!(!script.contains("</script") && !script.contains("<!--"));
        }
    }
}
