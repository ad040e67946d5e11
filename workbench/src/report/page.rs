//! Page frame of a report.
use maud::{DOCTYPE, Markup, PreEscaped, html};

/// Style of every report: dark on white; wide tables scroll; sections are not split in print.
const STYLE: &str = include_str!("page.css");

/// A complete HTML document.
pub fn page(title: &str, content: &Markup) -> String {
    let document = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (title) }
                style { (PreEscaped(STYLE)) }
            }
            body { main { (content) } }
        }
    };
    document.into_string()
}

/// A table of text cells with a header row; the first column has the names of the rows.
pub fn table(header: &[&str], rows: &[Vec<String>]) -> Markup {
    html! {
        div.scroll { table {
            thead { tr { @for name in header { th scope="col" { (name) } } } }
            tbody { @for row in rows { tr { @for (i, cell) in row.iter().enumerate() {
                @if i == 0 { th scope="row" { (cell) } } @else { td { (cell) } }
            } } } }
        } }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_escaped_and_nothing_is_fetched() {
        let text = page("a < b", &table(&["run"], &[vec!["<script>".to_owned()]]));
        assert!(text.contains("<title>a &lt; b</title>") && text.contains("&lt;script&gt;"));
        for reference in ["http:", "https:", "src=", "@import", "url("] {
            assert!(!text.contains(reference), "{reference}");
        }
    }
}
