//! Page frame of a report.
use std::fmt::Display;

use maud::{DOCTYPE, Markup, PreEscaped, html};

use crate::explanation::{self, Parameter};
use crate::web;
use hitch_output::text::joined;

/// Style of every report: wide tables scroll; sections are not split in print.
const STYLE: &str = include_str!("page.css");

/// Script of every report.
const SCRIPT: (&str, &str) = ("report.js", include_str!("report.js"));

/// Forbids the document to load anything, whatever its scripts do.
const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:";

/// Maximum number of rows of a table that is not folded.
const UNFOLDED_ROWS: usize = 12;

/// A complete HTML document, with the plotting library.
pub fn page(title: &str, content: &Markup) -> String {
    let script = web::bundle(web::MODULES.into_iter().chain([SCRIPT]));
    let document = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content=(POLICY);
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (title) }
                style { (PreEscaped(web::COLOURS)) (PreEscaped(STYLE)) }
            }
            body {
                main { (content) }
                script id="plotly" { (PreEscaped(web::PLOTLY)) }
                script type="module" { (PreEscaped(script)) }
            }
        }
    };
    document.into_string()
}

/// A table of text cells with a header row; the first column has the names of the rows. Cells may have several lines. A long
/// table is folded.
pub fn table<R>(header: &[&str], rows: impl IntoIterator<Item = R>) -> Markup
where
    R: IntoIterator<Item: AsRef<str>>,
{
    let rows: Vec<R> = rows.into_iter().collect();
    let count = rows.len();
    let table = html! {
        div.scroll tabindex="0" role="group" aria-label="Table" { table {
            thead { tr { @for name in header { th scope="col" { (name) } } } }
            tbody { @for row in rows { tr { @for (i, cell) in row.into_iter().enumerate() {
                @if i == 0 { th scope="row" { (lines(cell.as_ref())) } } @else { td { (lines(cell.as_ref())) } }
            } } } }
        } }
    };
    folded(&table, count)
}

/// The name of an effect with those that are indistinguishable from it.
pub fn with_twins(name: String, twins: &[impl Display]) -> String {
    if twins.is_empty() {
        return name;
    }
    format!("{name}\nnot to be told from {}", joined(twins, ", "))
}

/// What the parameters of effects mean, by name of the effect; folded.
pub fn meanings<'a>(effects: impl Iterator<Item = (String, &'a [Parameter])>) -> Markup {
    html! { details {
        summary { "What the parameters mean" }
        dl { @for (name, parameters) in effects { dt { (name) } dd { (explanation::meanings(parameters)) } } }
    } }
}

/// The lines of a cell.
fn lines(cell: &str) -> Markup {
    html! { @for (line, text) in cell.lines().enumerate() { @if line > 0 { br; } (text) } }
}

/// A table, folded if it has many rows.
pub fn folded(table: &Markup, rows: usize) -> Markup {
    if rows > UNFOLDED_ROWS {
        html! { details { summary { "Table of " (rows) " rows" } (table) } }
    } else {
        table.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_escaped_and_nothing_is_fetched() {
        let text = page("a < b", &table(&["run"], &[vec!["<script>".to_owned()]]));
        assert!(text.contains("<title>a &lt; b</title>") && text.contains("&lt;script&gt;"));
        let own = text.replacen(web::PLOTLY, "", 1);
        assert!(
            own.len() + 1_000_000 < text.len(),
            "the library is embedded"
        );
        assert!(own.contains("default-src 'none'"));
        for reference in [
            "http:", "https:", "src=", "href=", "@import", "url(", "import ",
        ] {
            assert!(!own.contains(reference), "{reference}");
        }
    }

    #[test]
    fn only_long_tables_are_folded() {
        let of = |rows: usize| table(&["run"], vec![vec!["a".to_owned()]; rows]).into_string();
        assert!(!of(12).contains("<details>"));
        assert!(of(13).contains("<summary>Table of 13 rows</summary>"));
    }
}
