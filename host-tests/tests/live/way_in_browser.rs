//! The whole way on the page of `hitch serve` in a browser: first model, constants, tuning, saved files.
//!
//! `cargo xtask test` installs the browser. The pictures of each view are kept in the target folder.

use host_tests::page_server::PageServer;
use tempfile::TempDir;

use crate::browser::operate;

#[test]
#[ignore = "needs Chromium; cargo xtask test installs it and runs this"]
fn the_way_is_gone_without_the_command_line() {
    let dir = TempDir::new().unwrap();
    let server = PageServer::start(dir.path(), &[]);
    let said = operate("way_in_browser.py", &server.page, &[]);
    assert!(said.contains("the way went well"), "{said}");
}
