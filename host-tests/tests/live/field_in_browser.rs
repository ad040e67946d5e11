//! The work on a field in the closed loop of `hitch serve` in a browser, at desktop and phone widths, in light and dark theme.
//!
//! `cargo xtask test` installs the browser. The pictures of each view are kept in the target folder.

use host_tests::page_server::PageServer;
use tempfile::TempDir;

use crate::browser::operate;

#[test]
#[ignore = "needs Chromium; cargo xtask test installs it and runs this"]
fn draft_control_works_a_field_on_the_page() {
    let dir = TempDir::new().unwrap();
    let server = PageServer::start(dir.path(), &[]);
    let said = operate("field_in_browser.py", &server.page, &[]);
    println!("{said}");
    assert!(said.contains("the field was worked"), "{said}");
}
