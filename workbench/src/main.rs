//! `hitch`: measurement -> physics -> firmware -> motion.
use std::process::ExitCode;

fn main() -> ExitCode {
    match hitch_workbench::cli::run(std::env::args_os()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            if !error.is_silent() {
                eprintln!("hitch: {error}");
            }
            error.exit_code()
        }
    }
}
