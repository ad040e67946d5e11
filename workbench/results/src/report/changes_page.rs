//! The report of `hitch changes`.

use maud::{Markup, html};

use super::{explanation_page, page};
use crate::explanation::{Explanation, Found};

/// The report as one HTML document: the changes of `new` since the campaign that `baseline` explains.
pub fn page(baseline: &Explanation, new: &Found) -> String {
    let (before, after) = (&baseline.head.campaign, &new.shown.head.campaign);
    let title = format!("What has changed from {before} to {after}");
    let content = html! {
        h1 { (title) }
        (reference(baseline))
        @if new.shown.steps.is_empty() { p.lead { (Explanation::UNCHANGED) } }
        (explanation_page::findings(new))
        (explanation_page::details(new))
    };
    page::page(&title, &content)
}

/// The model that the changes are counted from.
fn reference(baseline: &Explanation) -> Markup {
    html! { p { (baseline.as_reference(&format!("{:.2}", baseline.head.error_after))) "." } }
}
