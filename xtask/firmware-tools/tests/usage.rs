//! The tools as a program.

use std::process::Command;

#[test]
fn an_unknown_task_is_refused_with_the_known_ones() {
    let mut command = Command::new(env!("CARGO_BIN_EXE_firmware-tools"));
    let output = command.arg("flash").output().unwrap();
    assert!(!output.status.success());
    let text = String::from_utf8(output.stderr).unwrap();
    assert!(text.contains("unknown task `flash`"), "{text}");
    assert!(text.contains("usage: firmware-tools arm"), "{text}");
}
