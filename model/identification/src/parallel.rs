//! A function of many items, computed on all processors.
//!
//! The scheduler of rayon is compiled once here. Its parallel iterators are compiled again for each place that uses them: they were
//! two fifths of the machine code of this crate.

use std::sync::Mutex;

use rayon::prelude::*;

/// Values of a function of each item, in the order of the items. Calls may be nested.
pub fn map<I: Send, T: Send>(
    items: impl IntoIterator<Item = I>,
    value: impl Fn(I) -> T + Sync,
) -> Vec<T> {
    let places: Vec<Mutex<(Option<I>, Option<T>)>> = items
        .into_iter()
        .map(|item| Mutex::new((Some(item), None)))
        .collect();
    each(places.len(), &|index| {
        // No other thread has this place: its lock is free and no panic has poisoned it.
        if let Ok(mut place) = places[index].lock() {
            place.1 = place.0.take().map(&value);
        }
    });
    let values = places.into_iter();
    values
        .filter_map(|place| place.into_inner().ok()?.1)
        .collect()
}

fn each(count: usize, task: &(dyn Fn(usize) + Sync)) {
    (0..count).into_par_iter().for_each(task);
}

#[cfg(test)]
mod tests {
    use super::map;

    #[test]
    fn values_are_in_the_order_of_the_items_also_if_nested() {
        let squares = map(0..1000_u64, |a| map(0..a, |b| b).iter().sum::<u64>());
        let expected: Vec<u64> = (0..1000)
            .map(|a: u64| a * a.saturating_sub(1) / 2)
            .collect();
        assert_eq!(squares, expected);
    }
}
