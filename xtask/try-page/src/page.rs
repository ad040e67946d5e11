//! Joins the module with the scripts, styles and the section of the closed loop of `hitch serve`.

use anyhow::{Context, Result, ensure};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use hitch_results::web;

/// The page around the closed loop.
const PAGE: &str = include_str!("../../../workbench/try-page/assets/page.html");
/// The scripts of this page alone: the module as the answerer of requests, and what connects it.
const OWN: [(&str, &str); 2] = [
    (
        "module.js",
        include_str!("../../../workbench/try-page/assets/module.js"),
    ),
    (
        "try_page.js",
        include_str!("../../../workbench/try-page/assets/try_page.js"),
    ),
];
/// The scripts of `hitch serve` for its closed loop, in the order of their imports.
const SHARED: [&str; 11] = [
    "dom.js",
    "run_plot.js",
    "refused.js",
    "message.js",
    "linkage.js",
    "field_orders.js",
    "field_view.js",
    "loop_orders.js",
    "strip_chart.js",
    "valve_map.js",
    "closed_loop.js",
];

/// The page with a module.
///
/// # Errors
/// If a file of `hitch serve` or the section of its closed loop is missing.
pub fn page(module: &[u8]) -> Result<String> {
    let scripts = SHARED
        .iter()
        .map(|name| Ok((*name, served(name)?)))
        .chain(OWN.map(Ok))
        .collect::<Result<Vec<_>>>()?;
    let styles = [web::COLOURS, served("page.css")?].concat();
    let parts = [
        ("styles", styles),
        ("closed loop", closed_loop(served("")?)?.to_owned()),
        ("module", STANDARD.encode(module)),
        ("plotting library", web::PLOTLY.to_owned()),
        ("scripts", web::bundle(scripts)),
    ];
    filled(PAGE, &parts)
}

/// A page with its places, `[[name]]`, replaced by their parts.
fn filled(page: &str, parts: &[(&str, String)]) -> Result<String> {
    let mut filled = String::new();
    let mut rest = page;
    for (name, part) in parts {
        let place = format!("[[{name}]]");
        let (before, after) = rest
            .split_once(&place)
            .with_context(|| format!("page.html has no {place} after the part before it"))?;
        filled.extend([before, part]);
        rest = after;
    }
    filled.push_str(rest);
    Ok(filled)
}

/// The text of a file of `hitch serve`.
fn served(name: &str) -> Result<&'static str> {
    hitch_page::page_text(name)
        .with_context(|| format!("the page of hitch serve has no file {name:?}"))
}

/// The contents of the section of the closed loop.
fn closed_loop(page: &str) -> Result<&str> {
    let section = page
        .split_once("<section id=\"loop\"")
        .and_then(|(_, after)| after.split_once(">\n"))
        .and_then(|(_, inside)| inside.split_once("</section>"))
        .map(|(inside, _)| inside)
        .context("the page of hitch serve has no section #loop")?;
    ensure!(
        !section.contains("<section"),
        "the section #loop of hitch serve contains another: take its end into account"
    );
    Ok(section)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_has_every_element_of_the_loop_and_no_address() {
        let made = page(b"\0asm").expect("a page");
        for id in [
            "loop-lever",
            "loop-raise",
            "loop-load",
            "loop-oil",
            "loop-sensor",
            "loop-chart",
            "field-on",
            "field-view",
            "message",
        ] {
            assert!(made.contains(&format!("id=\"{id}\"")), "{id}");
        }
        let own = made.replace(web::PLOTLY, "");
        for loads in ["src=\"", "@import", "url(", "<link rel=\"stylesheet\""] {
            assert!(!own.contains(loads), "{loads}");
        }
        assert!(!own.lines().any(|line| line.starts_with("import ")));
    }

    #[test]
    fn a_part_may_contain_the_mark_of_another_place() {
        let parts = [("a", "1 [[b]]".to_owned()), ("b", "2".to_owned())];
        assert_eq!(
            filled("x [[a]] y [[b]] z", &parts).expect("places"),
            "x 1 [[b]] y 2 z"
        );
        assert!(filled("x [[b]]", &parts).is_err());
    }
}
