//! Many campaigns in one call: a line of JSON for each, written as soon as it is done.
mod line;
mod lines_file;
mod workers;

use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

use serde::Serialize;

use hitch_output::error::Error;
use hitch_output::is_stdout;
use hitch_output::progress::Progress;
use hitch_output::targets::{Outputs, campaign_files};

pub use line::{Line, Success};
use lines_file::LinesFile;

/// Options for many campaigns.
#[derive(Debug, Clone, clap::Args)]
pub struct FleetArgs {
    /// Write one line of JSON for each campaign to this file as soon as it is done, in the order of completion: `-` is
    /// standard output
    #[arg(long, value_name = "OUT")]
    jsonl: Option<PathBuf>,
    /// With --jsonl: number of campaigns that are processed at the same time; without this option, one for each core
    #[arg(long, value_name = "N", requires = "jsonl", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
    /// With --jsonl: append to OUT, and skip the campaigns that have a line there
    #[arg(long, requires = "jsonl")]
    resume: bool,
}

/// Result of a fleet.
#[derive(Debug, Default)]
struct Tally {
    done: usize,
    failed: usize,
}

impl FleetArgs {
    /// The only campaign of a command without `--jsonl`; `None` with it. `others` are the options for one campaign, and
    /// whether they are given.
    ///
    /// # Errors
    /// If the options do not suit the number of campaigns.
    pub fn single<'a>(
        &self,
        campaigns: &'a [PathBuf],
        others: &[(&str, bool)],
    ) -> Result<Option<&'a Path>, Error> {
        if self.jsonl.is_some() {
            return match others.iter().find(|(_, given)| *given) {
                Some((option, _)) => Err(Error::Usage(format!(
                    "{option} is for one campaign, --jsonl for many; omit one of them"
                ))),
                None => Ok(None),
            };
        }
        match campaigns {
            [campaign] => Ok(Some(campaign)),
            _ => Err(Error::Usage(format!(
                "{} campaigns need --jsonl OUT: it has a line for each; without it, give one campaign",
                campaigns.len()
            ))),
        }
    }

    /// Processes campaigns with `work`; `inputs` are the other files that the command reads.
    ///
    /// # Errors
    /// If OUT cannot be read or written, or a campaign failed.
    pub fn run<T: Serialize>(
        &self,
        campaigns: &[PathBuf],
        inputs: &[PathBuf],
        work: impl Fn(&Path) -> Result<T, Error> + Sync,
    ) -> Result<(), Error> {
        let Some(out) = &self.jsonl else {
            return Ok(());
        };
        let mut inputs = inputs.to_vec();
        inputs.extend(campaigns.iter().flat_map(|folder| campaign_files(folder)));
        let outputs = Outputs::check([Some(out.as_path())], &inputs)?;
        let (file, earlier) = LinesFile::open(out, self.resume)?;
        let mut waiting: Vec<String> = Vec::new();
        let mut before = Tally::default();
        for campaign in campaigns {
            let name = line::name(campaign);
            match earlier.get(&name) {
                Some(failed) => {
                    before.done += 1;
                    before.failed += usize::from(*failed);
                }
                None if waiting.contains(&name) => {}
                None => waiting.push(name),
            }
        }
        let now = self.process(&waiting, &file, &work)?;
        let (done, failed) = (now.done + before.done, now.failed + before.failed);
        outputs.say(|| {
            format!(
                "{done} campaigns in {}, {} of them from earlier calls; {failed} failed\n",
                out.display(),
                before.done
            )
        })?;
        match failed {
            0 => Ok(()),
            _ => {
                let place = Some(out).filter(|out| !is_stdout(out));
                let place = place.map_or(String::new(), |out| format!(" in {}", out.display()));
                Err(Error::Failed(format!(
                    "{failed} of {done} campaigns failed; their lines{place} have the reasons"
                )))
            }
        }
    }

    /// Processes the waiting campaigns, several at a time.
    fn process<T: Serialize>(
        &self,
        waiting: &[String],
        file: &LinesFile,
        work: &(impl Fn(&Path) -> Result<T, Error> + Sync),
    ) -> Result<Tally, Error> {
        let progress = Progress::of(waiting.len(), "processing campaigns");
        let state = Mutex::new((Tally::default(), None::<Error>));
        let stopped = AtomicBool::new(false);
        let one = |campaign: &String| {
            if stopped.load(Ordering::Relaxed) {
                return;
            }
            let (line, has_failed) =
                line::of(campaign, workers::guarded(|| work(Path::new(campaign))));
            let written = file.write(&line);
            // No code panics while it holds the lock.
            let Ok(mut state) = state.lock() else { return };
            state.0.done += 1;
            state.0.failed += usize::from(has_failed);
            progress.reach(state.0.done, format!("{campaign} is done"));
            if let Err(error) = written {
                stopped.store(true, Ordering::Relaxed);
                state.1.get_or_insert(error);
            }
        };
        workers::each(waiting, self.jobs.map(usize::from), &one)?;
        drop(progress);
        let (tally, fault) = state.into_inner().unwrap_or_default();
        fault.map_or(Ok(tally), Err)
    }
}
