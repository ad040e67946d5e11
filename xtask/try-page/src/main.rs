//! `cargo xtask try-page`.

use std::process::ExitCode;

fn main() -> ExitCode {
    match try_page::build(&try_page::folder()) {
        Ok(built) => {
            println!(
                "{}: {} bytes, of which the module of controller and plant has {}; open it in a browser",
                built.path.display(),
                built.bytes,
                built.module_bytes
            );
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("try-page: {error:#}");
            ExitCode::FAILURE
        }
    }
}
