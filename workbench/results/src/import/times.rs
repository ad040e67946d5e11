//! The times of a log: their column, and their unit if the log states none.

use hitch_campaign::survey::{
    LogColumn, TIMES, check_source, is_time_name, is_unit_of_time, unit_size_s, words,
};

use super::{Mapping, Note, Taken, Undetermined};

/// Longest step of a log whose unit is assumed, s.
const LONGEST_STEP_S: f64 = 0.5;
/// Shortest run whose unit of time is assumed, s.
const SHORTEST_RUN_S: f64 = 0.5;

/// The unit of times without one, and the reason.
///
/// # Errors
/// No unit, or more than one, makes them a run.
fn assumed_unit(column: &LogColumn) -> Result<(Option<&'static str>, String), Undetermined> {
    const UNITS: [(&str, f64); 7] = [
        ("s", 1.0),
        ("ms", 1e-3),
        ("us", 1e-6),
        ("ns", 1e-9),
        ("min", 60.0),
        ("h", 3_600.0),
        ("d", 86_400.0),
    ];
    /// Since 1970 in s or a part of it.
    const EPOCH: f64 = 1e8;
    /// Smallest numbers since 1970 in ns, us and ms, with the unit, s.
    const EPOCH_UNITS: [(f64, f64); 3] = [(1e17, 1e-9), (1e14, 1e-6), (1e11, 1e-3)];
    /// Days since 1900 (Excel) and since the year 0 (MATLAB), of the dates from 1980 to 2100.
    const DATES: [std::ops::Range<f64>; 2] = [29_000.0..74_000.0, 723_000.0..768_000.0];
    let words = words(&column.name);
    let last = words.last().filter(|_| words.len() > 1);
    let of_name = |(unit, _): &&(&str, f64)| last.is_some_and(|last| last == unit);
    if let Some(&(unit, size)) = UNITS.iter().find(of_name) {
        check_unit(column, unit, size)?;
        return Ok((Some(unit), format!("its name ends in the unit {unit}")));
    }
    let known: Vec<f64> = column
        .values
        .iter()
        .copied()
        .filter(|value| value.is_finite())
        .collect();
    let ([first, .., last], steps) = (&known[..], known.len() as f64 - 1.0) else {
        return Ok((None, "rises from row to row".to_owned()));
    };
    if *first >= EPOCH {
        let mut sizes = EPOCH_UNITS.into_iter().filter(|(from, _)| first >= from);
        let size_s = sizes.next().map_or(1.0, |(_, size_s)| size_s);
        check_run((last - first) * size_s, known.len()).map_err(|no_run| Undetermined {
            what: format!(
                "\"{}\" has no unit, and none can be assumed: counted from 1970 it {no_run}",
                column.name
            ),
            hint: format!("give it, as in --map {TIMES}=\"{}:us\"", column.name),
        })?;
        let reason = "rises from row to row; assumed to count from 1970: the log states no unit";
        return Ok((None, reason.to_owned()));
    }
    let (span, step) = (last - first, (last - first) / steps);
    let said = |unit: &str, size: f64| {
        let (lasts_s, rate_hz) = (span * size, 1.0 / (step * size));
        format!("in {unit} it lasts {lasts_s:.4} s at {rate_hz:.4} Hz")
    };
    if DATES.iter().any(|dates| dates.contains(first)) && step * 86_400.0 < LONGEST_STEP_S {
        let reason = format!(
            "assumed days: {}; the log states no unit",
            said("d", 86_400.0)
        );
        return Ok((Some("d"), reason));
    }
    let is_run = |size: f64| {
        let shortest_s = if size == 1.0 { 1e-4 } else { 5e-4 };
        (shortest_s..=LONGEST_STEP_S).contains(&(step * size)) && span * size >= SHORTEST_RUN_S
    };
    // A step of a whole number of a few digits is one that a logger is set to.
    let is_round = |size: f64| {
        let digits = step * size / 10_f64.powf((step * size).log10().floor() - 1.0);
        (digits - digits.round()).abs() < 1e-3
    };
    let runs: Vec<(&'static str, f64)> = UNITS
        .into_iter()
        .filter(|(_, size)| is_run(*size))
        .collect();
    let set: Vec<&(&str, f64)> = runs.iter().filter(|(_, size)| is_round(*size)).collect();
    let counts = step == 1.0;
    let unit = match (&runs[..], &set[..]) {
        _ if counts => None,
        ([first @ ("s", _), ..], set)
            if set.is_empty() || set.iter().any(|(unit, _)| *unit == "s") =>
        {
            Some(*first)
        }
        ([only], _) => Some(*only),
        _ => None,
    };
    match unit {
        Some((unit, size)) => {
            let reason = format!(
                "assumed {unit}: {}; the log states no unit",
                said(unit, size)
            );
            Ok((Some(unit), reason))
        }
        None => Err(Undetermined {
            what: format!(
                "\"{}\" has no unit, and none can be assumed: {}, {}",
                column.name,
                said("s", 1.0),
                said("ms", 1e-3)
            ),
            hint: format!("give it, as in --map {TIMES}=\"{}:ms\"", column.name),
        }),
    }
}

/// Checks times with a unit of the log: a run of no length is one in another unit.
fn check_unit(column: &LogColumn, unit: &str, size: f64) -> Result<(), Undetermined> {
    let known = column
        .values
        .iter()
        .copied()
        .filter(|value| value.is_finite());
    let known: Vec<f64> = known.collect();
    let [first, .., last] = known[..] else {
        return Ok(());
    };
    let Err(no_run) = check_run((last - first) * size, known.len()) else {
        return Ok(());
    };
    Err(Undetermined {
        what: format!(
            "the times \"{}\" {no_run}; the log states {unit}",
            column.name
        ),
        hint: format!(
            "give the unit, as in --map {TIMES}=\"{}:{unit}\"",
            column.name
        ),
    })
}

/// Whether times are those of a run; what they would be otherwise.
fn check_run(lasts_s: f64, samples: usize) -> Result<(), String> {
    let step_s = lasts_s / (samples as f64 - 1.0);
    if lasts_s >= SHORTEST_RUN_S / 10.0 && step_s < 1.0 {
        return Ok(());
    }
    let rate_hz = 1.0 / step_s;
    Err(format!(
        "would last {lasts_s:.4} s at {rate_hz:.4} Hz, which is no run of a hitch"
    ))
}

/// Checks the own times of a channel.
///
/// # Errors
/// They do not make a run of a hitch.
fn check_own(column: &LogColumn) -> Result<(), Undetermined> {
    let name = &column.name;
    let Some(lasts_s) = column.lasts_s else {
        return Ok(());
    };
    check_run(lasts_s, column.values.len()).map_err(|no_run| Undetermined {
        what: format!("the samples of \"{name}\" {no_run}: their times are probably not in s"),
        hint: format!(
            "save the file with times in s, or accept them with --map lift_current_a=\"{name}:{}\"",
            column.unit.as_deref().unwrap_or("A")
        ),
    })
}

/// What is assumed of times at other rates than those of the lift current, `main`, which are in `unit` if it is known.
///
/// # Errors
/// They last much longer or shorter than `main`.
fn others(
    main: &LogColumn,
    unit: Option<&str>,
    used: &[&LogColumn],
) -> Result<Vec<String>, Undetermined> {
    /// Largest plausible ratio of the durations of one recording.
    const RATIO: f64 = 10.0;
    let lasts = |column: &LogColumn| {
        let mut known = column.values.iter().filter(|value| value.is_finite());
        let first = known.next()?;
        Some(known.next_back()? - first)
    };
    let mut notes = Vec::new();
    for other in used.iter().filter(|other| !other.is_clock) {
        let name = &other.name;
        let own = unit_of_time(other);
        let assumed = own.or(unit);
        if let (Some(own_unit), Some(unit)) = (assumed, unit)
            && let (Some(own_lasts), Some(main_lasts)) = (lasts(other), lasts(main))
        {
            let [own_s, main_s] = [(own_lasts, own_unit), (main_lasts, unit)]
                .map(|(lasts, unit)| lasts * unit_size_s(unit));
            if !(main_s / RATIO..=main_s * RATIO).contains(&own_s) {
                return Err(Undetermined {
                    what: format!(
                        "the times \"{name}\" would last {own_s:.4} s in {own_unit}, and \"{}\" {main_s:.4} s in {unit}",
                        main.name
                    ),
                    hint: format!(
                        "write the unit behind the name in the header, as in \"{name} [ms]\", or leave the columns at \
                         these times out with --map CHANNEL="
                    ),
                });
            }
        }
        if own.is_none() {
            let unit = unit.unwrap_or("the unit");
            notes.push(format!(
                "assumed: \"{name}\" is in {unit}, as \"{}\"; the log states no unit",
                main.name
            ));
        }
    }
    Ok(notes)
}

/// The column of the times: that of the lift current, which the rows of a run are.
///
/// # Errors
/// The times do not make a run of a hitch.
pub fn time(
    columns: &[LogColumn],
    lift: Option<&LogColumn>,
) -> Result<Option<Taken>, Undetermined> {
    let taken = |source: String, reason: &str, is_assumed| Taken {
        channel: TIMES,
        source,
        reason: reason.to_owned(),
        is_assumed,
    };
    let is_base = |column: &&LogColumn| column.times.as_ref() == Some(&column.name);
    // Times that do not rise are read all the same: the reader names the line that is wrong.
    let is_said = |column: &&LogColumn| {
        column.is_clock || is_time_name(&column.name) || unit_of_time(column).is_some()
    };
    let base = lift.and_then(|lift| lift.times.as_ref());
    let base = columns.iter().find(|column| Some(&column.name) == base);
    let base = base.or_else(|| columns.iter().find(is_base));
    let Some(column) = base.or_else(|| columns.iter().find(is_said)) else {
        return Ok(None);
    };
    if column.is_clock {
        let reason = "dates or times of day";
        return Ok(Some(taken(column.name.clone(), reason, false)));
    }
    let name = &column.name;
    if let Some(unit) = unit_of_time(column) {
        check_unit(column, unit, unit_size_s(unit))?;
        let source = format!("{name}:{unit}");
        return Ok(Some(taken(source, "times with a unit", false)));
    }
    let (unit, reason) = assumed_unit(column)?;
    let source = unit.map_or_else(|| name.clone(), |unit| format!("{name}:{unit}"));
    Ok(Some(taken(source, &reason, true)))
}

impl Mapping {
    /// Notes the times of columns at other rates.
    pub(super) fn note_other_times(&mut self, columns: &[LogColumn]) -> Result<(), Undetermined> {
        let time = self.taken.iter().find(|taken| taken.channel == TIMES);
        let Some((name, unit)) = time.and_then(|time| check_source(TIMES, &time.source).ok())
        else {
            return Ok(());
        };
        let Some(main) = columns.iter().find(|column| column.name == name) else {
            return Ok(());
        };
        let of_lift = self.source_of(columns, "lift_current_a");
        let rows = of_lift.and_then(|lift| lift.times.clone());
        let mut used: Vec<&LogColumn> = Vec::new();
        for taken in &self.taken {
            let column = self.source_of(columns, taken.channel);
            let base = column.and_then(|column| column.times.as_ref());
            let is_other = base.is_some() && base != Some(&name) && base != rows.as_ref();
            let base = columns.iter().find(|column| Some(&column.name) == base);
            used.extend(base.filter(|base| is_other && !used.contains(base)));
        }
        let notes = others(main, unit.as_deref().or(main.unit.as_deref()), &used)?;
        self.notes.extend(notes.into_iter().map(Note::plain));
        Ok(())
    }

    /// Checks the times of the lift current's channel, unless the user assigned it.
    pub(super) fn check_own_times(
        &self,
        columns: &[LogColumn],
        named: &[(String, String)],
    ) -> Result<(), Undetermined> {
        const LIFT: &str = "lift_current_a";
        let is_given = named.iter().any(|(channel, _)| channel == LIFT);
        match self.source_of(columns, LIFT) {
            Some(column) if !is_given => check_own(column),
            _ => Ok(()),
        }
    }
}

fn unit_of_time(column: &LogColumn) -> Option<&str> {
    column.unit.as_deref().filter(|unit| is_unit_of_time(unit))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn column(first: f64, step: f64, samples: i32) -> LogColumn {
        LogColumn {
            name: "Time".to_owned(),
            values: (0..samples).map(|i| first + step * f64::from(i)).collect(),
            ..LogColumn::default()
        }
    }

    #[test]
    fn a_unit_is_assumed_if_it_alone_makes_a_run() {
        for (first, step, unit) in [
            (0.0, 0.02, "s"),
            (0.0, 0.001, "s"),
            (0.0, 20.0, "ms"),
            (0.0, 20_000.0, "us"),
            (0.0, 0.02 / 60.0, "min"),
            (46_347.416_67, 0.02 / 86_400.0, "d"),
            (740_000.416_67, 0.02 / 86_400.0, "d"),
        ] {
            let (got, reason) = assumed_unit(&column(first, step, 900)).unwrap();
            assert_eq!(got, Some(unit), "{first} {step}: {reason}");
            assert!(reason.contains("assumed"), "{reason}");
        }
        assert_eq!(assumed_unit(&column(1.8e9, 0.02, 900)).unwrap().0, None);
        // A counter of us that has run for some minutes.
        let fault = assumed_unit(&column(1e9, 20_000.0, 351)).unwrap_err();
        assert!(fault.what.contains("counted from 1970"), "{}", fault.what);
        for (step, samples) in [(1.0, 1_200), (1e-9, 900), (700.0, 20)] {
            let fault = assumed_unit(&column(0.0, step, samples)).unwrap_err();
            assert!(fault.what.contains("no unit"), "{}", fault.what);
        }
    }

    #[test]
    fn a_stated_unit_has_to_make_a_run() {
        assert!(check_unit(&column(0.0, 20.0, 351), "ms", 1e-3).is_ok());
        assert!(check_unit(&column(0.0, 0.02, 351), "ms", 1e-3).is_err());
        assert!(check_unit(&column(0.0, 1.0, 1_200), "s", 1.0).is_err());
    }
}
