//! Confounded alternatives: effects that may explain as much as an identified one.

use crate::search::best_subset::fitted;
use crate::search::dictionary::Dictionary;
use crate::search::dictionary_entry::Kind;

/// Share of the cost reduction of an effect that an alternative has to predict in its place. A secant predicts at the
/// simulated size; an alternative that explains as much at its optimal size predicts most of it at that one.
const CONFOUNDED_SHARE: f64 = 0.5;

/// Ids of the effects that predict about the same cost reduction as one of the effects of the dictionary's fit, by its
/// index.
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
        .filter(|&column| without - cost(Some(column)) >= CONFOUNDED_SHARE * explained)
        .map(|column| entries[column].id())
        .collect();
    ids.sort_unstable();
    ids.dedup();
    ids
}
