//! The counters of a test: how often each piece of code was reached, and each condition was true and false.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result};
use llvm_profparser::instrumentation_profile::types::InstrumentationProfile;
use llvm_profparser::{
    Counter, CounterType, CoverageMapping, ExprKind, FunctionRecordV3, RegionKind,
};

/// A piece of code, by its file relative to the workspace's root; line and column of its begin and its end.
pub type Place = (PathBuf, [usize; 4]);

/// How often a condition was true and false.
#[derive(Clone, Copy, Debug, Default)]
pub struct Taken {
    pub yes: i64,
    pub no: i64,
}

impl Taken {
    /// The outcome that no test has, if there is one.
    pub fn open(self) -> Option<&'static str> {
        match (self.yes, self.no) {
            (0, 0) => Some("neither true nor false"),
            (0, _) => Some("never true"),
            (_, 0) => Some("never false"),
            _ => None,
        }
    }
}

/// What the tests have reached.
#[derive(Debug, Default)]
pub struct Counted {
    /// How often each piece of code was reached.
    pub pieces: BTreeMap<Place, i64>,
    /// The conditions.
    pub branches: BTreeMap<Place, Taken>,
}

/// The counters of the files that are `covered`. Copies of a function count together.
pub fn counted(
    mapping: &CoverageMapping<'_>,
    profile: &InstrumentationProfile,
    root: &Path,
    covered: &[&str],
) -> Result<Counted> {
    let mut found = Counted::default();
    for info in mapping.mapping_info_iter() {
        let info = info.context("can't read the counters' places")?;
        for function in &info.cov_fun {
            let files = info.get_files_from_id(function.header.filenames_ref);
            let counts = profile
                .find_record_by_hash(function.header.name_hash)
                .map_or(&[][..], |record| &record.record.counts[..]);
            for region in &function.regions {
                let Some(file) = files.get(region.file_id) else {
                    continue;
                };
                let file = file.strip_prefix(root).unwrap_or(file);
                if !covered.iter().any(|covered| file.starts_with(covered)) {
                    continue;
                }
                let at = &region.loc;
                let lines = [at.line_start, at.column_start, at.line_end, at.column_end];
                let place = (file.to_owned(), lines);
                let yes = count(region.count, function, counts);
                *found.pieces.entry(place.clone()).or_default() += yes;
                if region.kind == RegionKind::Branch {
                    let taken = found.branches.entry(place).or_default();
                    taken.yes += yes;
                    taken.no += count(region.false_count, function, counts);
                }
            }
        }
    }
    Ok(found)
}

/// The value of a counter, or of an expression of counters.
fn count(counter: Counter, function: &FunctionRecordV3, counts: &[u64]) -> i64 {
    let index = usize::try_from(counter.id).unwrap_or(usize::MAX);
    match counter.kind {
        CounterType::Zero => 0,
        CounterType::ProfileInstrumentation => counts
            .get(index)
            .map_or(0, |count| i64::try_from(*count).unwrap_or(i64::MAX)),
        CounterType::Expression(kind) => function.expressions.get(index).map_or(0, |both| {
            let lhs = count(both.lhs, function, counts);
            let rhs = count(both.rhs, function, counts);
            match kind {
                ExprKind::Add => lhs + rhs,
                ExprKind::Subtract => lhs - rhs,
            }
        }),
    }
}
