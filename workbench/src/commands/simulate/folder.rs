//! A folder of simulated runs that is a campaign.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use hitch_campaign::{Campaign, Run};
use hitch_model_file::quoted;
use hitch_plant::Channel;

use hitch_output::error::Error;
use hitch_results::import::run_block::RunBlock;

/// A new campaign, with the runs so far.
pub struct Folder {
    path: PathBuf,
    /// Names of the logs.
    names: HashSet<String>,
    /// Tables of the runs in the manifest.
    runs: String,
}

impl Folder {
    /// An empty campaign at a path.
    ///
    /// # Errors
    /// If it is not writable, or has files already.
    pub fn new(path: &Path) -> Result<Self, Error> {
        hitch_output::check_new_folder("--out", path)?;
        Ok(Self {
            path: path.to_path_buf(),
            names: HashSet::new(),
            runs: String::new(),
        })
    }

    /// Adds a run with its simulated log.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn add(&mut self, run: &Run, log: &str) -> Result<(), Error> {
        let name = name_of_log(&run.file, &mut self.names);
        hitch_output::create_folder(&self.path)?;
        hitch_output::write_file(&self.path.join(&name), log.as_bytes())?;
        let block = RunBlock {
            file: &name,
            then: &[],
            bench: run.bench,
            oil_temperature_c: Some(run.oil_temperature_c),
            span_s: None,
        };
        self.runs += &block.to_string();
        Ok(())
    }

    /// Writes the manifest, with the noise of the instruments of the campaign that was simulated.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn finish(self, simulated: Option<&Campaign>) -> Result<(), Error> {
        let name = self.path.file_name().unwrap_or(self.path.as_os_str());
        let name = quoted(&name.to_string_lossy());
        let head = format!("format = 1\nname = {name}\ndescription = \"Simulated\"\n");
        let noise = simulated.map_or(String::new(), noise);
        let text = head + &noise + &self.runs;
        hitch_output::write_file(&self.path.join("campaign.toml"), text.as_bytes())
    }
}

/// The table of the noise of a campaign's instruments; empty if none is stated.
fn noise(campaign: &Campaign) -> String {
    let noise = &campaign.noise;
    let channels = Channel::ALL.map(|channel| (channel.key(), noise.of(channel)));
    let currents = [
        ("lift_current_a", noise.lift_current_a),
        ("lower_current_a", noise.lower_current_a),
    ];
    let stated = currents.into_iter().chain(channels);
    let lines = stated.filter_map(|(key, sigma)| Some(format!("{key} = {:?}\n", sigma?)));
    let lines: String = lines.collect();
    if lines.is_empty() {
        lines
    } else {
        format!("\n[noise]\n{lines}")
    }
}

/// A name for the log of a run: that of its file, with a number if it is taken.
fn name_of_log(label: &str, taken: &mut HashSet<String>) -> String {
    let file = Path::new(label).file_name().unwrap_or_default();
    let file = file.to_string_lossy();
    let stem = stem(&file);
    let names = (2..).map(|number| format!("{stem}_{number}.csv"));
    let names = std::iter::once(format!("{stem}.csv")).chain(names);
    hitch_output::first_free(names, |name| !taken.insert(name.to_owned()))
}

/// The name of a run without the extension of its file and the time span behind it.
fn stem(file: &str) -> &str {
    let is_extension = |at: usize| {
        let word = file[at + 1..].split(' ').next().unwrap_or_default();
        word.starts_with(char::is_alphabetic) && word.chars().all(char::is_alphanumeric)
    };
    let mut points = file.rmatch_indices('.').map(|(at, _)| at);
    let end = points.find(|&at| is_extension(at));
    end.map_or(file, |at| &file[..at])
}

#[cfg(test)]
mod tests {
    use std::collections::HashSet;

    use super::name_of_log;

    #[test]
    fn every_run_has_a_file_of_its_own() {
        let mut taken = HashSet::new();
        let labels = [
            "a/lift_1.5A.csv",
            "b/lift_1.5A.csv",
            "monday.log 12 to 47.5 s",
            "monday.log from 80 s",
        ];
        let names = labels.map(|label| name_of_log(label, &mut taken));
        assert_eq!(
            names,
            [
                "lift_1.5A.csv",
                "lift_1.5A_2.csv",
                "monday.csv",
                "monday_2.csv"
            ]
        );
    }
}
