//! `hitch`: measurement -> physics -> firmware -> motion.
use std::process::ExitCode;

use hitch_output::text::colour::BAD;

fn main() -> ExitCode {
    match hitch_workbench::cli::run(std::env::args_os()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            if !error.is_silent() {
                let (style, reset) = (BAD.render(), BAD.render_reset());
                anstream::eprintln!("{style}hitch:{reset} {error}");
            }
            error.exit_code()
        }
    }
}
