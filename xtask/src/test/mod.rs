//! Every test: those of the host, and those that need the emulated target or a browser.

mod affected;
mod jobs;
mod programs;

use std::fs;
use std::path::PathBuf;
use std::thread;

use anyhow::{Context, Result, bail};
use arm_build::toolchain::{ARM, Way};
use arm_build::{images, process, setup, workspace};

use crate::timings::{self, Timings};
pub use affected::packages;
pub use jobs::Selection;
use jobs::{Counts, Done};
use programs::Built;

/// Environment variable with the image for the tests that run it.
const IMAGE_VARIABLE: &str = "HITCH_EMULATED_IMAGE";
/// Environment variable with its maximum stack depth, in bytes.
const STACK_VARIABLE: &str = "HITCH_STACK_BOUND";
/// Environment variable with the folder of the images for the parts.
const IMAGES_VARIABLE: &str = "HITCH_BOARD_IMAGES";
/// Names the program `hitch` for the tests that run it.
const PROGRAM_VARIABLE: &str = "HITCH_PROGRAM";

/// The test programs, the images, and what they need.
#[derive(Debug)]
pub struct Tests {
    way: Way,
    built: Built,
    tools: PathBuf,
}

impl Tests {
    /// Installs what is missing, and builds the test programs and the images.
    ///
    /// # Errors
    /// If something is missing and can't be installed, or does not compile.
    pub fn build(way: Option<Way>, timings: &mut Timings) -> Result<Self> {
        let way = timings.measured("set-up of toolchain, emulator and browser", || {
            let way = setup::toolchain(way, ARM)?;
            setup::EMULATOR.find()?;
            setup::BROWSER.find()?;
            Ok(way)
        })?;
        let options: &[&str] = if timings.asked() { &["--timings"] } else { &[] };
        // The images are linked by one thread each, which leaves the other processors to the tests' build.
        let built = timings.measured("build of test programs and images", || {
            thread::scope(|scope| {
                let images = scope.spawn(|| images::build_all(way));
                let built = Built::new(options);
                images
                    .join()
                    .expect("the build of the images does not panic")?;
                built
            })
        })?;
        if timings.asked() {
            timings.add_units(&timings::units(&workspace::target())?);
        }
        let tools = built.binary("firmware_tools")?.to_owned();
        Ok(Self { way, built, tools })
    }

    /// Runs a task of `firmware-tools`.
    ///
    /// # Errors
    /// If it fails.
    pub fn tool(&self, arguments: &[&str]) -> Result<()> {
        process::run(&mut process::command(&self.tools, arguments))
    }

    /// Runs the selected tests; finally prints a line with their numbers.
    ///
    /// # Errors
    /// If one fails, or an image is over its budget.
    pub fn run(&self, selection: &Selection, timings: &mut Timings) -> Result<()> {
        timings.measured("images: checksums, sizes, stacks", || {
            self.tool(&["arm", self.way.name()])
        })?;
        let variables = [
            (PROGRAM_VARIABLE, self.built.binary("hitch")?.to_owned()),
            (IMAGE_VARIABLE, images::emulated(self.way)),
            (IMAGES_VARIABLE, images::folder(self.way)),
            (STACK_VARIABLE, stack_bound(self.way)?.into()),
        ];
        let done = timings.measured("run of the tests", || {
            jobs::run(&self.built, selection, &variables)
        })?;
        if timings.asked() {
            if *selection == Selection::All {
                jobs::record(&done)?;
            }
            let rows = done.iter().map(|job| (job.name.clone(), job.seconds));
            timings.add_longest("&nbsp; ", rows.collect(), 3.0);
        }
        timings.print();
        summarise(&done)
    }
}

/// Maximum stack depth of the image for the emulator, as text.
fn stack_bound(way: Way) -> Result<String> {
    let path = images::emulated(way).with_extension("stack");
    fs::read_to_string(&path).with_context(|| path.display().to_string())
}

fn summarise(done: &[Done]) -> Result<()> {
    let mut total = Counts::default();
    for job in done {
        total.passed += job.counts.passed;
        total.failed += job.counts.failed;
        if job.counts.failed > 0 {
            println!("\n{}: {}", job.name, job.counts);
        }
    }
    println!("\n{total}");
    if total.failed > 0 || total.passed == 0 {
        bail!("tests failed; see above, or search for `FAILED`");
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failed_test_or_none_at_all_fails_the_whole() {
        let done = |passed, failed| Done {
            name: String::new(),
            counts: Counts { passed, failed },
            seconds: 0.0,
        };
        assert!(summarise(&[done(3, 0), done(1, 0)]).is_ok());
        assert!(summarise(&[done(3, 1), done(1, 0)]).is_err());
        assert!(summarise(&[]).is_err());
    }
}
