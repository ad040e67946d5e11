//! `campaign.toml` of a draft campaign.
//!
//! ```toml
//! format = 1
//! name = "Plough in the south field"
//!
//! [implement]
//! kind = "mouldboard-plough"
//! width_m = 1.2              # or tools = 11, as the table of the standard counts
//!
//! [soil]
//! texture = "medium"         # fine, medium or coarse
//!
//! [columns]                  # only for names that are not time, speed, depth and draft
//! draft = ["Kraft links:kN", "Kraft rechts:kN"]
//!
//! [[run]]
//! file = "16cm_4kmh.csv"
//! lane = "a"                 # runs of one lane share their wheel tracks; without it, each run has its own
//! ```

use std::path::Path;

use hitch_campaign::folder::{file_in, file_name, folder_name, manifest_of};
use hitch_field::draft::Texture;
use hitch_input::input_error::{InputError, quote};
use hitch_input::naming::offer_names;
use hitch_input::toml_reader::TomlTable;

use crate::block::Run;
use crate::log::{self, Mapping, QUANTITIES};
use crate::machine::{KINDS, Machine, TEXTURES};

/// A draft campaign.
#[derive(Debug, Clone, PartialEq)]
pub struct Campaign {
    /// Its name.
    pub name: String,
    /// Implement and soil.
    pub machine: Machine,
    /// Its runs.
    pub runs: Vec<Run>,
}

/// Range of working widths, m.
const WIDTH_M: std::ops::RangeInclusive<f64> = 0.1..=20.0;
/// Range of numbers of tools.
const TOOLS: std::ops::RangeInclusive<f64> = 1.0..=200.0;
/// Largest number of lanes: each is weighed as a possible wheel track.
const MOST_LANES: usize = 100;

impl Campaign {
    /// Reads the campaign of a folder.
    ///
    /// # Errors
    /// The first fault, with file, line and column.
    pub fn load(dir: &Path) -> Result<Self, InputError> {
        let source = manifest_of(dir)?;
        let top = TomlTable::parse(&source)?;
        top.only(&[
            "format",
            "name",
            "description",
            "implement",
            "soil",
            "columns",
            "run",
        ])?;
        top.check_format()?;
        let name = top.text("name")?.map(str::to_owned);
        Ok(Self {
            name: name.unwrap_or_else(|| folder_name(dir)),
            machine: machine(&top)?,
            runs: runs(dir, &top)?,
        })
    }
}

fn machine(top: &TomlTable<'_>) -> Result<Machine, InputError> {
    let implement = top
        .table("implement")?
        .ok_or_else(|| top.missing("implement"))?;
    implement.only(&["kind", "width_m", "tools"])?;
    let names = KINDS.map(|kind| kind.name);
    let kind = chosen(&implement, "kind", &names)?;
    let kind = KINDS[kind];
    let (key, other, range) = if kind.counts_tools {
        ("tools", "width_m", TOOLS)
    } else {
        ("width_m", "tools", WIDTH_M)
    };
    if implement.has(other) {
        let what = format!("the standard does not count {other} of a {}", kind.name);
        return Err(implement.error_at(other, what, format!("write {key} = ... instead")));
    }
    let width = implement.required_number(key, range)?;
    let soil = top.table("soil")?.ok_or_else(|| top.missing("soil"))?;
    soil.only(&["texture"])?;
    let names = TEXTURES.map(|(name, _)| name);
    let texture: Texture = TEXTURES[chosen(&soil, "texture", &names)?].1;
    Ok(Machine {
        kind,
        width,
        texture,
    })
}

/// Index of the name that a key has.
fn chosen(table: &TomlTable<'_>, key: &str, names: &[&str]) -> Result<usize, InputError> {
    let text = table.required_text(key)?;
    let known = names.iter().position(|name| *name == text);
    known.ok_or_else(|| {
        let what = format!("{key} {} is not known", quote(text));
        table.error_at(key, what, offer_names(text, names))
    })
}

fn mapping(table: &TomlTable<'_>) -> Result<Option<Mapping>, InputError> {
    let Some(columns) = table.table("columns")? else {
        return Ok(None);
    };
    columns.only(&QUANTITIES.map(|quantity| quantity.name))?;
    let mut mapping = Mapping::default();
    for (names, quantity) in mapping.columns.iter_mut().zip(&QUANTITIES) {
        let key = quantity.name;
        // Only drafts add up.
        *names = match columns.text(key) {
            Err(_) if key == "draft" => columns.texts(key)?.map(owned),
            text => text?.map(|text| vec![text.to_owned()]),
        }
        .unwrap_or_default();
    }
    Ok(Some(mapping))
}

fn owned(texts: Vec<&str>) -> Vec<String> {
    texts.into_iter().map(str::to_owned).collect()
}

fn runs(dir: &Path, top: &TomlTable<'_>) -> Result<Vec<Run>, InputError> {
    let tables = top.tables("run")?;
    if tables.is_empty() {
        let hint = "add a [[run]] block for every log";
        return Err(top.error_at("run", "the campaign has no runs", hint));
    }
    let common = mapping(top)?.unwrap_or_default();
    let mut runs: Vec<Run> = Vec::new();
    let mut lanes: Vec<String> = Vec::new();
    for table in &tables {
        table.only(&["file", "lane", "columns"])?;
        let file = file_name(table, "file")?;
        let path = file_in(dir, table, "file")?;
        if runs.iter().any(|run| run.name == file) {
            let what = format!("{} is listed twice", quote(file));
            return Err(table.error_at("file", what, "delete one of the two [[run]] blocks"));
        }
        let lane = table.text("lane")?.unwrap_or(file).to_owned();
        if !lanes.contains(&lane) {
            lanes.push(lane.clone());
        }
        if lanes.len() > MOST_LANES {
            let what = format!("the campaign has more than {MOST_LANES} lanes");
            return Err(table.error(
                what,
                "give neighbouring runs one lane, or divide the campaign",
            ));
        }
        let own = mapping(table)?;
        runs.push(Run {
            name: file.to_owned(),
            lane,
            samples: log::read(&path, own.as_ref().unwrap_or(&common))?,
        });
    }
    Ok(runs)
}
