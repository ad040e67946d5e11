//! The columns of times of a log, and the columns that each belongs to.
//!
//! A log may have a column of times for each rate. A column belongs to the times whose name it shares, else to those before
//! it; the number of samples decides if these do not fit.

use hitch_input::written_unit::spelling;

use crate::run_columns::TIMES as TIME_COLUMN;
use crate::scale::Scale;
use crate::series::rises;

/// Part by which the number of samples of a column may fall short of that of its times: dropouts.
const FITS: f64 = 0.9;
/// Words of the times.
const TIMES: [&str; 10] = [
    "zeit",
    "time",
    "timestamp",
    "zeitstempel",
    "uhrzeit",
    "datum",
    "date",
    "sec",
    "t",
    "x_value",
];

/// A column as far as its times matter.
#[derive(Debug, Clone, Default)]
pub struct Seen {
    /// Its name.
    pub name: String,
    /// Whether its unit is one of times.
    pub is_in_time: bool,
    /// Whether it has any unit.
    pub has_unit: bool,
    /// Whether it contains dates or times of day.
    pub is_clock: bool,
    /// Number of samples.
    pub samples: usize,
    /// Whether its values rise from sample to sample.
    pub rises: bool,
}

impl Seen {
    /// A column with these samples, in a unit of any spelling.
    pub fn new(name: &str, unit: Option<&str>, values: &[f64]) -> Self {
        Self {
            name: name.to_owned(),
            is_in_time: unit.is_some_and(|unit| is_unit_of_time(spelling(unit))),
            has_unit: unit.is_some(),
            is_clock: false,
            samples: values.len(),
            rises: rises(values),
        }
    }
}

/// Whether a name denotes times.
#[must_use]
pub fn is_time_name(name: &str) -> bool {
    let words = words(name);
    TIMES.iter().any(|known| is_in(known, &words)) || TIMES.contains(&&*name.to_lowercase())
}

/// The words of a name in lower case; `LiftCurrent` and `ILift` have two.
#[must_use]
pub fn words(name: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let (mut was_small, mut was_large) = (false, false);
    for letter in name.chars() {
        let begins = !letter.is_alphabetic() || (letter.is_uppercase() && was_small);
        if was_large
            && letter.is_lowercase()
            && let Some(first) = words.last_mut().and_then(String::pop)
        {
            // The last one of several large letters begins a word.
            words.push(first.into());
        }
        (was_small, was_large) = (letter.is_lowercase(), letter.is_uppercase());
        if begins {
            words.push(String::new());
        }
        if let (true, Some(word)) = (letter.is_alphabetic(), words.last_mut()) {
            word.extend(letter.to_lowercase());
        }
    }
    words.retain(|word| !word.is_empty());
    words
}

/// Whether a known word is a word of the name; a long one may also be part of a word (German compounds).
#[must_use]
pub fn is_in(known: &str, words: &[String]) -> bool {
    /// Minimum length of a partial match; shorter words occur in many others.
    const LONG: usize = 5;
    let is_part = |word: &String| known.len() >= LONG && word.contains(known);
    words.iter().any(|word| word == known || is_part(word))
}

/// The column of times of each column, itself for one of times; `None` in a log without times.
pub fn bases(columns: &[Seen]) -> Vec<Option<usize>> {
    let is_time = |column: &Seen| {
        let is_possible = column.is_in_time || column.is_clock || !column.has_unit;
        let is_said = column.is_in_time || column.is_clock || is_time_name(&column.name);
        column.rises && is_possible && is_said
    };
    let times: Vec<usize> = (0..columns.len())
        .filter(|&index| is_time(&columns[index]))
        .collect();
    let base = |index: usize| {
        if times.contains(&index) {
            return Some(index);
        }
        let before = times.iter().rev().find(|&&time| time < index);
        let usual = before.or(times.first()).copied()?;
        let samples = columns[index].samples as f64;
        let fits = |time: usize| {
            let most = columns[time].samples as f64;
            samples <= most && samples >= FITS * most
        };
        let mut others = times.iter().copied().filter(|&time| fits(time));
        let by_name = times
            .iter()
            .copied()
            .find(|&time| is_named_after(&columns[time], &columns[index]));
        by_name.or_else(|| {
            if fits(usual) {
                Some(usual)
            } else {
                others.next().or(Some(usual))
            }
        })
    };
    (0..columns.len()).map(base).collect()
}

/// Whether times are named after a column: `t_druck` and `druck`, `Time slow` and `Pressure slow`.
fn is_named_after(times: &Seen, column: &Seen) -> bool {
    let of_column = words(&column.name);
    let mut own = words(&times.name);
    own.retain(|word| !TIMES.contains(&word.as_str()));
    !own.is_empty() && own.iter().all(|word| of_column.contains(word))
}

/// The times of a column, if the user assigned `main` to the lift current.
pub fn base_of(bases: &[Option<usize>], column: usize, main: usize, lift: Option<usize>) -> usize {
    let of_lift = lift.and_then(|lift| bases.get(lift).copied().flatten());
    let own = bases.get(column).copied().flatten();
    match own {
        Some(own) if Some(own) != of_lift => own,
        _ => main,
    }
}

/// Conversion of times other than the assigned ones: by their own unit, else as the assigned ones.
pub fn scale(own: Option<&str>, main: Option<Scale>) -> Option<Scale> {
    own.map_or(main, |unit| Scale::of(unit, &TIME_COLUMN).ok())
}

/// Whether a unit is one of times.
#[must_use]
pub fn is_unit_of_time(unit: &str) -> bool {
    Scale::of(unit, &TIME_COLUMN).is_ok()
}

/// Size of a unit of time, s; 1 for one that is not known.
#[must_use]
pub fn unit_size_s(unit: &str) -> f64 {
    match Scale::of(unit, &TIME_COLUMN) {
        Ok(Scale::Line { factor, .. }) => factor,
        _ => 1.0,
    }
}

/// What a reader of the log should know about its times, one line each.
pub fn notes(columns: &[Seen], bases: &[Option<usize>]) -> Vec<String> {
    let times: Vec<usize> = (0..columns.len())
        .filter(|&index| bases[index] == Some(index))
        .collect();
    if times.len() < 2 {
        return Vec::new();
    }
    let note = |time: usize| {
        let name = &columns[time].name;
        let owned = (0..columns.len()).filter(|&index| index != time && bases[index] == Some(time));
        let owned: Vec<&str> = owned
            .map(|index| columns[index].name.as_str())
            .filter(|name| !name.is_empty())
            .collect();
        if owned.is_empty() {
            format!("\"{name}\" has times as well, and no column of its own: it is not used")
        } else {
            format!("\"{name}\" has the times of {}", owned.join(", "))
        }
    };
    times.into_iter().map(note).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn seen(name: &str, samples: usize, is_time: bool) -> Seen {
        Seen {
            name: name.to_owned(),
            samples,
            is_in_time: is_time,
            rises: is_time,
            has_unit: true,
            is_clock: false,
        }
    }

    #[test]
    fn columns_belong_to_times_by_name_by_place_and_by_number() {
        let by_place = [
            seen("Time 1", 100, true),
            seen("I", 100, false),
            seen("Time 2", 20, true),
            seen("p", 20, false),
        ];
        assert_eq!(bases(&by_place), [Some(0), Some(0), Some(2), Some(2)]);
        let by_name = [
            seen("t_fast", 9, true),
            seen("t_slow", 9, true),
            seen("I_fast", 9, false),
            seen("p_slow", 9, false),
        ];
        assert_eq!(bases(&by_name), [Some(0), Some(1), Some(0), Some(1)]);
        let by_number = [
            seen("Time 1", 100, true),
            seen("Time 2", 20, true),
            seen("I", 99, false),
            seen("p", 20, false),
        ];
        assert_eq!(bases(&by_number), [Some(0), Some(1), Some(0), Some(1)]);
        assert_eq!(bases(&[seen("p", 20, false)]), [None]);
        assert_eq!(words("LiftCurrent"), ["lift", "current"]);
        assert_eq!(words("ILift pCyl"), ["i", "lift", "p", "cyl"]);
        assert!(
            is_time_name("Zeit")
                && is_time_name("t")
                && is_time_name("X_Value")
                && !is_time_name("Temperatur")
        );
    }
}
