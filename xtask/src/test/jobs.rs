//! Runs the tests in jobs: a job is a module of a test program, in a process of its own.
//!
//! A module shares what its tests prepare once, and is small enough to keep all processors busy until the end. The jobs
//! with the longest recorded time start first.

use std::collections::BTreeMap;
use std::fmt;
use std::fs;
use std::path::PathBuf;
use std::process::{Output, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::Instant;

use anyhow::{Context, Result, ensure};
use arm_build::programs::Program;
use arm_build::workspace;

use super::affected;
use super::programs::{self, Built};

/// Recorded times, relative to the workspace's root.
const RECORD: &str = "xtask/test-seconds.txt";
/// Shorter jobs are not recorded, s.
const SHORTEST_S: f64 = 1.0;

/// Package of the acceptance tests.
const ACCEPTANCE: &str = "host-tests ";
/// Time from which an acceptance test is left to the whole test, s.
const LONG_S: f64 = 8.0;

/// The program with tests in real time: they mostly wait, and run one after the other beside the others. Two at a time, with a
/// browser among them, leave the ECU behind real time on two processors.
const WAITING: &str = "live";
/// Modules of that program that compute all the time.
const COMPUTING: [&str; 3] = ["board_bench", "emulated", "emulated_ecu"];
/// Modules of that program that measure times of the page, and run alone.
const ALONE: [&str; 2] = ["overlay_in_browser", "page_in_browser"];

/// Which jobs run at the same time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Lane {
    /// One on each processor.
    Computing,
    /// One at a time beside those.
    Waiting,
    /// One at a time after all others.
    Alone,
}

/// Numbers of tests by result.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Passed.
    pub passed: u32,
    /// Failed.
    pub failed: u32,
}

impl fmt::Display for Counts {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} passed, {} failed", self.passed, self.failed)
    }
}

/// Which jobs run.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Selection {
    /// Every one.
    #[default]
    All,
    /// Those with a text in their names.
    Named(String),
    /// Those of packages that changes since a commit concern; of the acceptance tests, which depend on everything, the short ones.
    Since(String),
}

impl Selection {
    /// Removes what is not selected; returns the names of the long jobs that changes concern and that are left out.
    fn select(&self, jobs: &mut Vec<Job>, time_s: impl Fn(&Job) -> f64) -> Result<Vec<String>> {
        let mut left_out = Vec::new();
        match self {
            Self::All => {}
            Self::Named(text) => jobs.retain(|job| job.name.contains(text)),
            Self::Since(commit) => {
                let folders = affected::since(commit)?;
                let folders: Vec<PathBuf> = folders
                    .iter()
                    .map(|folder| workspace::root().join(folder))
                    .collect();
                jobs.retain(|job| folders.contains(&job.program.folder));
                let is_short =
                    |job: &Job| !job.name.starts_with(ACCEPTANCE) || time_s(job) < LONG_S;
                let long = jobs.iter().filter(|job| !is_short(job));
                left_out = long.map(|job| job.name.clone()).collect();
                jobs.retain(is_short);
            }
        }
        Ok(left_out)
    }
}

/// A module of a test program.
#[derive(Clone, Debug)]
struct Job {
    program: Program,
    /// Its package and program, and the module.
    name: String,
    /// Its tests, by their full names.
    tests: Vec<String>,
    lane: Lane,
}

/// A job that has ended.
#[derive(Clone, Debug)]
pub struct Done {
    /// Package, program and module.
    pub name: String,
    /// Results of its tests.
    pub counts: Counts,
    /// Wall time, s.
    pub seconds: f64,
}

/// Runs the tests of the programs with these environment variables; prints the output of each job when it has ended.
///
/// # Errors
/// If a program does not start, or a job reports another number of tests than it has.
pub fn run(
    built: &Built,
    selection: &Selection,
    variables: &[(&str, PathBuf)],
) -> Result<Vec<Done>> {
    let mut jobs = Vec::new();
    for program in built.tests() {
        jobs.extend(of_program(program)?);
    }
    let expected_s = recorded();
    let time_s = |job: &Job| expected_s.get(&job.name).copied().unwrap_or_default();
    jobs.sort_by(|a, b| time_s(b).total_cmp(&time_s(a)));
    let left_out = selection.select(&mut jobs, time_s)?;
    let of = |lane: Lane| jobs.iter().filter(move |job| job.lane == lane).collect();
    let processors = thread::available_parallelism().map_or(1, usize::from);
    let (computing, waiting): (Vec<&Job>, Vec<&Job>) = (of(Lane::Computing), of(Lane::Waiting));
    let (computed, waited) = thread::scope(|scope| {
        let waited = scope.spawn(|| in_lanes(&waiting, 1, variables));
        let computed = in_lanes(&computing, processors, variables);
        (computed, waited.join().expect("no lane panics"))
    });
    let alone: Vec<&Job> = of(Lane::Alone);
    let done = [computed?, waited?, in_lanes(&alone, 1, variables)?].concat();
    if !left_out.is_empty() {
        println!("\nleft to the whole test:\n  {}", left_out.join("\n  "));
    }
    Ok(done)
}

/// The jobs of a program.
fn of_program(program: &Program) -> Result<Vec<Job>> {
    let package = program.folder.strip_prefix(workspace::root());
    let package = package.unwrap_or(&program.folder).display();
    let mut modules: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for test in programs::list(program)? {
        let module = test.rsplit_once("::").map_or("", |(module, _)| module);
        modules.entry(module.to_owned()).or_default().push(test);
    }
    let job = |(module, tests): (String, Vec<String>)| Job {
        program: program.clone(),
        name: format!("{package} {} {module}", program.name)
            .trim_end()
            .to_owned(),
        lane: lane(program, module.split("::").next().unwrap_or_default()),
        tests,
    };
    Ok(modules.into_iter().map(job).collect())
}

/// The lane of a module of a program.
fn lane(program: &Program, module: &str) -> Lane {
    match module {
        _ if program.name != WAITING || COMPUTING.contains(&module) => Lane::Computing,
        _ if ALONE.contains(&module) => Lane::Alone,
        _ => Lane::Waiting,
    }
}

/// Runs jobs in their order, as many at a time as there are lanes.
fn in_lanes(jobs: &[&Job], lanes: usize, variables: &[(&str, PathBuf)]) -> Result<Vec<Done>> {
    let next = AtomicUsize::new(0);
    let done = Mutex::new(Vec::new());
    let lane = || -> Result<()> {
        while let Some(job) = jobs.get(next.fetch_add(1, Ordering::Relaxed)) {
            match job.run(variables) {
                Ok(ended) => done.lock().expect("no lane panics").push(ended),
                Err(error) => {
                    // The other lanes start no further job.
                    next.store(jobs.len(), Ordering::Relaxed);
                    return Err(error);
                }
            }
        }
        Ok(())
    };
    thread::scope(|scope| {
        let lanes: Vec<_> = (0..lanes).map(|_| scope.spawn(lane)).collect();
        lanes
            .into_iter()
            .try_for_each(|lane| lane.join().expect("no lane panics"))
    })?;
    Ok(done.into_inner().expect("no lane panics"))
}

impl Job {
    /// Runs it, and prints its output.
    fn run(&self, variables: &[(&str, PathBuf)]) -> Result<Done> {
        let started = Instant::now();
        let mut command = programs::command(&self.program);
        command
            .args([
                "--include-ignored",
                "--nocapture",
                "--test-threads",
                "1",
                "--exact",
            ])
            .args(&self.tests)
            .envs(variables.iter().map(|(name, path)| (name, path)))
            .stdout(Stdio::piped())
            .stderr(Stdio::piped());
        let output = command
            .output()
            .with_context(|| format!("can't start {}", self.program.path.display()))?;
        let seconds = started.elapsed().as_secs_f64();
        let text = text(&output);
        println!("\n== {}: {seconds:.1} s\n{}", self.name, text.trim());
        // The last one: a test may itself print the result of a program that it has run.
        let counts = text.lines().rev().find_map(counts_in);
        let counts = match (counts, output.status.success()) {
            (Some(counts), true) => counts,
            // A test that ends its process leaves no closing line: all tests of the job count as failed.
            (Some(counts), false) if counts.failed > 0 => counts,
            _ => Counts {
                passed: 0,
                failed: u32::try_from(self.tests.len())?,
            },
        };
        ensure!(
            (counts.passed + counts.failed) as usize == self.tests.len(),
            "{}: {counts} of {} tests",
            self.name,
            self.tests.len()
        );
        Ok(Done {
            name: self.name.clone(),
            counts,
            seconds,
        })
    }
}

/// What it printed: output, then errors.
fn text(output: &Output) -> String {
    [&output.stdout, &output.stderr]
        .map(|bytes| String::from_utf8_lossy(bytes).into_owned())
        .concat()
}

/// The counts in a line like `test result: ok. 3 passed; 0 failed; 1 ignored; ...`.
fn counts_in(line: &str) -> Option<Counts> {
    let (_, results) = line.strip_prefix("test result: ")?.split_once(". ")?;
    let count = |what: &str| {
        results
            .split("; ")
            .find_map(|part| part.strip_suffix(what)?.trim().parse().ok())
    };
    Some(Counts {
        passed: count(" passed")?,
        failed: count(" failed")?,
    })
}

/// The recorded times of the jobs, s.
fn recorded() -> BTreeMap<String, f64> {
    let text = fs::read_to_string(workspace::root().join(RECORD)).unwrap_or_default();
    let line = |line: &str| {
        let (seconds, name) = line.split_once(' ')?;
        Some((name.to_owned(), seconds.parse().ok()?))
    };
    text.lines().filter_map(line).collect()
}

/// Records the times of the jobs.
///
/// # Errors
/// If the file cannot be written.
pub fn record(done: &[Done]) -> Result<()> {
    let mut long: Vec<&Done> = done
        .iter()
        .filter(|job| job.seconds >= SHORTEST_S)
        .collect();
    long.sort_by(|a, b| b.seconds.total_cmp(&a.seconds));
    let lines: String = long
        .iter()
        .map(|job| format!("{:.0} {}\n", job.seconds, job.name))
        .collect();
    let title = "# Seconds of the longer jobs of the tests, which start first. Written by `cargo xtask test --timings`.\n";
    fs::write(workspace::root().join(RECORD), format!("{title}{lines}")).context(RECORD)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_come_from_the_closing_line_of_each_test_program() {
        let line = "test result: FAILED. 12 passed; 3 failed; 1 ignored; 0 measured; 0 filtered out; finished in 0.5s";
        assert_eq!(
            counts_in(line),
            Some(Counts {
                passed: 12,
                failed: 3
            })
        );
        assert_eq!(counts_in("test kinematics ... ok"), None);
    }

    #[test]
    fn every_job_runs_once_in_any_number_of_lanes() {
        // The program of this test has this test; a job of another module ends at once.
        let program = programs::of_this_test();
        let job = |name: &str| Job {
            program: program.clone(),
            name: name.to_owned(),
            tests: vec![
                "test::jobs::tests::counts_come_from_the_closing_line_of_each_test_program"
                    .to_owned(),
            ],
            lane: Lane::Computing,
        };
        let jobs: Vec<Job> = (0..5).map(|index| job(&index.to_string())).collect();
        for lanes in 1..4 {
            let mut done = in_lanes(&jobs.iter().collect::<Vec<_>>(), lanes, &[]).unwrap();
            done.sort_by(|a, b| a.name.cmp(&b.name));
            let names: Vec<&str> = done.iter().map(|done| done.name.as_str()).collect();
            assert_eq!(names, ["0", "1", "2", "3", "4"]);
            assert!(done.iter().all(|done| done.counts.passed == 1));
        }
    }

    #[test]
    fn a_job_that_ends_without_a_closing_line_has_failed() {
        let mut program = programs::of_this_test();
        program.path = "/bin/false".into();
        let job = Job {
            program,
            name: "none".to_owned(),
            tests: vec!["a".to_owned(), "b".to_owned()],
            lane: Lane::Computing,
        };
        let counts = job.run(&[]).unwrap().counts;
        assert_eq!((counts.passed, counts.failed), (0, 2));
    }
}
