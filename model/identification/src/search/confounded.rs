//! Confounded alternatives: what may explain as much as an effect that was found.

use crate::search::best_subset::fitted;
use crate::search::dictionary::Dictionary;
use crate::search::dictionary_entry::Kind;

/// Share of what an effect explains that another has to promise beside the same others. A secant promises at the size
/// that was simulated; what explains as much at its best size promises most of it.
const AS_MUCH: f64 = 0.5;

/// The ids of the effects that promise as much as one of the fit that a dictionary was made around, by its index there.
pub(crate) fn confounded(dictionary: &Dictionary, effect: usize) -> Vec<&'static str> {
    let (gram, entries) = (&dictionary.gram, dictionary.entries.as_slice());
    let columns = |keeps: &dyn Fn(Kind) -> bool| -> Vec<usize> {
        let kept = (0..entries.len()).filter(|&column| keeps(entries[column].kind));
        kept.collect()
    };
    let others = columns(&|kind| matches!(kind, Kind::Present(other) if other != effect));
    let cost = |column: Option<usize>| {
        let columns = others.iter().copied().chain(column);
        fitted(gram, entries, columns.collect()).cost
    };
    let Some(&own) = columns(&|kind| kind == Kind::Present(effect)).first() else {
        return Vec::new();
    };
    let without = cost(None);
    let explained = without - cost(Some(own));
    let mut ids: Vec<&'static str> = columns(&|kind| !matches!(kind, Kind::Present(_)))
        .into_iter()
        .filter(|&column| without - cost(Some(column)) >= AS_MUCH * explained)
        .map(|column| entries[column].id())
        .collect();
    ids.sort_unstable();
    ids.dedup();
    ids
}
