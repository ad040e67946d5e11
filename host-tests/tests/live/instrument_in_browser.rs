//! The page of `hitch serve` as an instrument in a browser, in a small and a large window and on a phone.
//!
//! `cargo xtask test` installs the browser. The pictures of each view are kept in the target folder.

use host_tests::page_server::PageServer;
use tempfile::TempDir;

use crate::browser::operate;

#[test]
#[ignore = "needs Chromium; cargo xtask test installs it and runs this"]
fn plots_stay_in_view_and_follow() {
    let dir = TempDir::new().unwrap();
    let server = PageServer::start(dir.path(), &[]);
    let said = operate("instrument_in_browser.py", &server.page, &[]);
    println!("{said}");
    assert!(said.contains("the instrument went well"), "{said}");
}
