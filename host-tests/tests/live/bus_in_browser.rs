//! The page of `hitch serve --can` in a browser, at desktop and phone widths, and in the dark theme.
//!
//! `cargo xtask test` installs the browser. The pictures of each view are kept in the target folder.

use std::path::Path;
use std::process::Command;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{scope, sleep};
use std::time::Duration;

use hitch_ecu_host::ecu::slcan_server::SlcanServer;
use hitch_ecu_host::ecu::{CutFlash, OnHost};
use host_tests::live_ecu::{self, Operator};
use host_tests::page_server::PageServer;
use host_tests::python::{environment, run, scripts};
use tempfile::TempDir;

#[test]
#[ignore = "needs Chromium; cargo xtask test installs it and runs this"]
fn an_ecu_on_the_bus_is_watched() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let python = environment(&scripts().join("browser.txt"), folder).unwrap();
    let dir = TempDir::new().unwrap();
    let bus = SlcanServer::open("127.0.0.1:0").unwrap();
    let address = bus.address().unwrap().to_string();
    let end = dir.path().join("end");
    let (ecu_done, all_done) = (AtomicBool::new(false), AtomicBool::new(false));
    let said = scope(|scope| {
        scope.spawn(|| {
            live_ecu::run(
                &mut OnHost::start(CutFlash::blank()),
                bus,
                Operator::Working,
                &ecu_done,
            )
        });
        scope.spawn(|| {
            while !end.exists() && !all_done.load(Ordering::Relaxed) {
                sleep(Duration::from_millis(50));
            }
            ecu_done.store(true, Ordering::Relaxed);
        });
        let said = std::panic::catch_unwind(|| {
            let server = PageServer::start(dir.path(), &["--can", &address]);
            let mut command = Command::new(python);
            command
                .arg(scripts().join("bus_in_browser.py"))
                .arg(&server.page)
                .arg(&end)
                .arg("chromium")
                .arg(folder.join("pictures"))
                .env("PYTHONPYCACHEPREFIX", folder.join("python-cache"));
            run(&mut command)
        });
        all_done.store(true, Ordering::Relaxed);
        said.unwrap()
    });
    let said = said.unwrap_or_else(|reason| panic!("{reason:#}"));
    assert!(said.contains("the bus was watched"), "{said}");
}
