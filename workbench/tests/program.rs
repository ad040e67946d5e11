//! The program starts. With this test the build of all tests contains the program, for the tests that run it.

use std::process::Command;

#[test]
fn the_program_states_its_version() {
    let output = Command::new(env!("CARGO_BIN_EXE_hitch"))
        .arg("--version")
        .output()
        .expect("it starts");
    let text = String::from_utf8_lossy(&output.stdout);
    assert_eq!(text.trim(), concat!("hitch ", env!("CARGO_PKG_VERSION")));
}
