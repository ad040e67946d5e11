//! Project tasks that need more than cargo.

mod ablation;
mod benchmarks;
mod check;
mod circles;
mod dependencies;
mod documents;
mod layers;
mod mutants;
mod scripts;
mod sources;
mod test;
mod timings;

use std::process::{Command, ExitCode};

use anyhow::{Context, Result, bail};
use arm_build::toolchain::Way;
use arm_build::{process, setup, workspace};
use test::{Selection, Tests};
use timings::Timings;

const USAGE: &str = "\
usage: cargo xtask <task> [--arm rustup|debian] [--timings]

  test [--only TEXT | --since COMMIT]
          set up what is missing, build the ARM images, run every test, say how many passed; or only the tests of the
          programs and modules with this text in their names, e.g. `motion teach`; or those of the packages that were
          changed since a commit and of all that depend on them, without acceptance tests of more than 8 s, which are
          named at the end: for work between two whole tests
  check   formatting, the order of folders, circles of files, types of the scripts, clippy and rustdoc, with warnings denied
  ci      check, coverage, then test; mutants as well if HITCH_THOROUGH is set, else it names what they have not been run on
  arm     build the ARM images, say how large they are, and hold them to their budgets
  sizes   write down how large the images are and how deep their stacks get, in firmware/sizes.txt
  stack   show the calls that make the images' stacks deepest
  coverage run the safety envelope's tests; each piece of its code has to be reached
  mutants [--again]
          change the safety envelope, position control, storage and remote control in every way that cargo-mutants
          knows; their tests have to notice. Only if their code is not the one for which firmware/mutants.txt says
          that they do, or with --again
  ablations identification|control [NAME...]
          remove one heuristic of xtask/ablations.toml at a time and print what the benchmark loses
  benchmarks [NAME...]
          measure the results in docs/BENCHMARKS.md, or those of these names, again and write them into it
  replay [--against COMMIT] [--steps N] [--seed SEED]
          feed controller and safety envelope of an earlier commit and of the present sources the same random and
          recorded steps, and list every difference; exit code 1 if docs/safety.md does not explain all of them
  dependencies
          build the program into an empty folder, and print what each direct dependency of it costs
  a2l     write firmware/hitch.a2l, the description of parameters and measurements for tuning tools
  try-page build target/try-page/index.html, the closed loop of controller and plant in one page without server and network
  setup   find or install the ARM toolchain and the emulator

  --arm   take this ARM toolchain instead of the first that works:
          rustup   the target thumbv7em-none-eabihf of the toolchain in use
          debian   the packages rustc-web, cargo-web and rust-web-src
  --timings
          print a table of where the time of check, test or ci went, and record the times of the tests in
          xtask/test-seconds.txt";

fn main() -> ExitCode {
    match run(&std::env::args().skip(1).collect::<Vec<_>>()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("xtask: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &[String]) -> Result<()> {
    let (task, options) = arguments.split_first().context(USAGE)?;
    if task == "ablations" {
        return ablation::run(options);
    }
    if task == "benchmarks" {
        return benchmarks::run(options);
    }
    if task == "replay" {
        return replay(options);
    }
    let options = Options::parse(options)?;
    let mut timings = Timings::new(options.timings);
    let way = options.way;
    match task.as_str() {
        "test" => Tests::build(way, &mut timings)?.run(&options.selection, &mut timings)?,
        "check" => {
            check::run(way, &mut timings)?;
            timings.print();
        }
        "ci" => {
            check::run(way, &mut timings)?;
            let tests = Tests::build(way, &mut timings)?;
            timings.measured("coverage", || tests.tool(&["coverage"]))?;
            timings.measured("mutants", || {
                if is_thorough() {
                    mutants::run(false)
                } else {
                    mutants::report()
                }
            })?;
            tests.run(&Selection::All, &mut timings)?;
        }
        "arm" | "sizes" | "stack" | "coverage" | "a2l" => build_firmware_tool(task, way)?,
        "dependencies" => dependencies::run()?,
        "try-page" => process::run(&mut package("try-page"))?,
        "mutants" => mutants::run(options.again)?,
        "setup" => setup::run(way)?,
        "help" | "--help" | "-h" => println!("{USAGE}"),
        unknown => bail!("unknown task `{unknown}`\n{USAGE}"),
    }
    Ok(())
}

/// Whether this is the nightly run, with everything that takes long.
fn is_thorough() -> bool {
    std::env::var_os("HITCH_THOROUGH").is_some()
}

/// Options after the task.
#[derive(Debug, Default)]
struct Options {
    way: Option<Way>,
    timings: bool,
    again: bool,
    selection: Selection,
}

impl Options {
    fn parse(words: &[String]) -> Result<Self> {
        let mut options = Self::default();
        let mut words = words.iter().map(String::as_str);
        while let Some(word) = words.next() {
            match word {
                "--arm" => options.way = Some(words.next().context(USAGE)?.parse()?),
                "--timings" => options.timings = true,
                "--only" => {
                    options.selection = Selection::Named(words.next().context(USAGE)?.to_owned());
                }
                "--since" => {
                    options.selection = Selection::Since(words.next().context(USAGE)?.to_owned());
                }
                "--again" => options.again = true,
                _ => bail!("unknown option `{word}`\n{USAGE}"),
            }
        }
        Ok(options)
    }
}

/// Builds and runs the paired replay of two commits; its exit code is that of this program.
fn replay(options: &[String]) -> Result<()> {
    let mut command = package("paired-replay");
    command
        .arg("--folder")
        .arg(workspace::target().join("replay"))
        .args(options);
    process::announce(&command);
    let status = command.status().context("can't start cargo")?;
    std::process::exit(status.code().unwrap_or(2));
}

/// Builds `firmware-tools`, and runs a task of it.
fn build_firmware_tool(task: &str, way: Option<Way>) -> Result<()> {
    let arguments: Vec<&str> = std::iter::once(task).chain(way.map(Way::name)).collect();
    process::run(package("firmware-tools").args(arguments))
}

/// Builds and runs the program of a package; its arguments follow.
fn package(name: &str) -> Command {
    let options = ["run", "--quiet", "--locked", "--package", name, "--"];
    process::command(workspace::cargo(), &options)
}
