//! The page that has controller and plant inside, in a browser without network, at desktop and phone widths, in light and dark
//! theme.
//!
//! `cargo xtask test` installs the browser. The pictures of each view are kept in the target folder.

use crate::browser::operate;

#[test]
#[ignore = "needs Chromium; cargo xtask test installs it and runs this"]
fn the_closed_loop_runs_without_a_server() {
    let folder = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("try-page");
    let built = try_page::build(&folder).unwrap_or_else(|reason| panic!("{reason:#}"));
    println!("{built:?}");
    let address = format!("file://{}", built.path.display());
    let said = operate("try_page_in_browser.py", &address, &[]);
    println!("{said}");
    assert!(said.contains("the page was tried"), "{said}");
}
