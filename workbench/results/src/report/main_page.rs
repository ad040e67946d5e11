//! The report of the main job: from measurements to motion.
use maud::html;

use super::{explanation_page, page, rebuild_page};
use crate::closed_loop::rebuild::Rebuild;
use crate::explanation::Found;

/// The report as one HTML document.
pub fn page(found: &Found, rebuild: &Rebuild) -> String {
    let title = format!("{}: from measurements to motion", found.shown.head.campaign);
    let content = html! {
        h1 { (title) }
        (explanation_page::findings(found))
        (rebuild_page::sections(rebuild))
        (explanation_page::details(found))
    };
    page::page(&title, &content)
}
