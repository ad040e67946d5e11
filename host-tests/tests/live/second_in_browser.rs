//! Two models compared in the page of `hitch serve` in a browser, at desktop and phone widths, in light and dark theme, and in print.
//!
//! `cargo xtask test` installs the browser. The pictures of each view are kept in the target folder.
use std::fs;

use host_tests::page_server::PageServer;
use serde_json::json;
use tempfile::TempDir;

use crate::browser::operate;

#[test]
#[ignore = "needs Chromium; cargo xtask test installs it and runs this"]
fn two_models_are_compared() {
    let dir = TempDir::new().unwrap();
    let server = PageServer::start(dir.path(), &[]);
    let session = server.begin();
    let task = json!({ "session": session, "task": "add", "effect": "lower-threshold-shift" });
    assert_eq!(server.post("api/start", &task).status, 200);
    let _ = server.settled(&session);
    let [fitted, broken] = ["fitted.toml", "broken.toml"].map(|name| dir.path().join(name));
    let saved = server.get(&format!("api/model?session={session}")).body;
    fs::write(&fitted, &saved).unwrap();
    fs::write(&broken, saved.replacen("_mm = ", "_mm = \"oops\" #", 1)).unwrap();
    let said = operate("second_in_browser.py", &server.page, &[&fitted, &broken]);
    assert!(said.contains("the comparison went well"), "{said}");
}
