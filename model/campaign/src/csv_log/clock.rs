//! Times of a log: seconds and their multiples, epoch times, dates and times of day.

use std::ops::RangeInclusive;

use crate::scale::Scale;

/// Seconds per day.
const DAY_S: f64 = 86_400.0;
/// Smallest epoch time, s: three years. No log lasts that long.
const EPOCH_FROM_S: f64 = 1e8;
/// The magnitude of an epoch time without a unit selects its unit: limit, and unit above it in s (ns, us, ms).
const EPOCH_UNITS: [(f64, f64); 3] = [(1e17, 1e-9), (1e14, 1e-6), (1e11, 1e-3)];

/// Reads the times of a log in order.
#[derive(Debug)]
pub struct Times {
    /// Size of the log's time unit, s; `None` if unknown.
    unit_s: Option<f64>,
    begin: Option<Begin>,
    /// The last time of day, s, and the number of days before it.
    last: (f64, f64),
}

/// The first time of a log.
#[derive(Debug, Clone, Copy)]
enum Begin {
    /// A number, and the size of its unit, s.
    Number { first: f64, unit_s: f64 },
    /// A time of day, or date and time, s.
    Clock { first_s: f64 },
}

impl Times {
    /// For a log with this time unit, if known.
    pub fn new(scale: Option<Scale>) -> Self {
        let unit_s = match scale {
            Some(Scale::Line { factor, .. }) => Some(factor),
            _ => None,
        };
        Self {
            unit_s,
            begin: None,
            last: (f64::NEG_INFINITY, 0.0),
        }
    }

    /// The time in a cell, s; epoch and clock times are relative to the first one. `None` if the cell contains no time.
    pub fn read(&mut self, cell: &str) -> Option<f64> {
        match number(cell) {
            Some(number) => self.of_number(number),
            None => self.of_clock(parse(cell)?),
        }
    }

    /// The time of a number, s; epoch times are relative to the first one. `None` after a clock time.
    pub fn of_number(&mut self, number: f64) -> Option<f64> {
        let begin = self.begin.unwrap_or_else(|| {
            let unit_s = self.unit_s.unwrap_or_else(|| guessed_unit_s(number));
            let counts_from_epoch = number * unit_s >= EPOCH_FROM_S;
            Begin::Number {
                first: if counts_from_epoch { number } else { 0.0 },
                unit_s,
            }
        });
        self.begin = Some(begin);
        match begin {
            Begin::Number { first, unit_s } => Some((number - first) * unit_s),
            Begin::Clock { .. } => None,
        }
    }

    /// How much later the first of these times is than that of others, s; zero unless both are absolute.
    pub fn later_than_s(&self, other: &Self) -> f64 {
        let first_s = |times: &Self| match times.begin? {
            Begin::Number { first, unit_s } => (first != 0.0).then_some(first * unit_s),
            Begin::Clock { first_s } => Some(first_s),
        };
        let both = first_s(self).zip(first_s(other));
        both.map_or(0.0, |(own_s, other_s)| own_s - other_s)
    }

    fn of_clock(&mut self, time: Instant) -> Option<f64> {
        let time_s = match time.day {
            Some(day) => day * DAY_S + time.of_day_s,
            None => self.since_first_midnight_s(time.of_day_s),
        };
        let begin = *self.begin.get_or_insert(Begin::Clock { first_s: time_s });
        match begin {
            Begin::Clock { first_s } => Some(time_s - first_s),
            Begin::Number { .. } => None,
        }
    }

    /// A time of day without a date decreases by nearly a day at midnight.
    fn since_first_midnight_s(&mut self, of_day_s: f64) -> f64 {
        let (last_s, mut days) = self.last;
        if of_day_s < last_s - DAY_S / 2.0 {
            days += 1.0;
        }
        self.last = (of_day_s, days);
        days * DAY_S + of_day_s
    }
}

fn guessed_unit_s(number: f64) -> f64 {
    let known = EPOCH_UNITS.iter().find(|(from, _)| number >= *from);
    known.map_or(1.0, |(_, unit_s)| *unit_s)
}

/// A number with a decimal point or comma.
fn number(cell: &str) -> Option<f64> {
    let is_number = |text: &str| {
        let number: f64 = text.parse().ok()?;
        number.is_finite().then_some(number)
    };
    is_number(cell).or_else(|| is_number(&cell.replacen(',', ".", 1)))
}

/// Whether a cell contains a date or a time of day.
pub fn is_clock(cell: &str) -> bool {
    number(cell).is_none() && parse(cell).is_some()
}

/// A date and time, or a time of day.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Instant {
    /// Days since 1970-01-01, if there is a date.
    day: Option<f64>,
    /// Seconds since midnight.
    of_day_s: f64,
}

/// Reads `2026-11-21T10:00:00.123Z`, `21.11.2026 10:00:00,123`, `11/21/2026 10:00:00 PM`, `10:00:00.123`.
fn parse(cell: &str) -> Option<Instant> {
    let cell = cell.trim();
    let (date, clock) = match cell.split_once(['T', 't', ' ']) {
        Some((date, clock)) if !date.contains(':') => (Some(date), clock.trim_start()),
        _ => (None, cell),
    };
    let day = match date {
        Some(date) => Some(day_of(date.trim_end_matches(','))?),
        None => None,
    };
    Some(Instant {
        day,
        of_day_s: of_day_s(clock)?,
    })
}

/// Parses `10:00:00.123`, followed by `AM` or `PM`, `Z` or an offset.
fn of_day_s(text: &str) -> Option<f64> {
    let upper = text.trim().to_ascii_uppercase();
    let (text, afternoon) = match (upper.strip_suffix("AM"), upper.strip_suffix("PM")) {
        (Some(text), _) => (text.trim_end(), Some(false)),
        (_, Some(text)) => (text.trim_end(), Some(true)),
        _ => (upper.as_str(), None),
    };
    let text = text.strip_suffix('Z').unwrap_or(text);
    let (clock, offset_s) = match text.find(['+', '-']) {
        Some(sign) => (&text[..sign], offset_s(&text[sign..])?),
        None => (text, 0.0),
    };
    let mut parts = clock.trim_end().split(':');
    let hour = whole(parts.next()?, 0..=23)?;
    let minute = whole(parts.next()?, 0..=59)?;
    let second = match parts.next() {
        Some(text) => seconds(text)?,
        None => 0.0,
    };
    if parts.next().is_some() {
        return None;
    }
    let hour = match afternoon {
        Some(afternoon) => hour % 12 + if afternoon { 12 } else { 0 },
        None => hour,
    };
    Some(f64::from(hour * 60 + minute) * 60.0 + second - offset_s)
}

/// Parses an offset: `+01:00`, `-0530`, `+01`.
fn offset_s(text: &str) -> Option<f64> {
    let sign = if text.starts_with('-') { -1.0 } else { 1.0 };
    let digits = text[1..].replace(':', "");
    let (hours, minutes) = match digits.len() {
        2 => (digits.as_str(), "0"),
        4 => digits.split_at_checked(2)?,
        _ => return None,
    };
    let minutes = whole(hours, 0..=14)? * 60 + whole(minutes, 0..=59)?;
    Some(sign * f64::from(minutes) * 60.0)
}

fn seconds(text: &str) -> Option<f64> {
    let is_plain = text
        .bytes()
        .all(|b| b.is_ascii_digit() || matches!(b, b'.' | b','));
    let value = number(text).filter(|_| is_plain)?;
    // Second 60 is a leap second.
    (0.0..61.0).contains(&value).then_some(value)
}

fn whole(text: &str, range: RangeInclusive<u32>) -> Option<u32> {
    let is_plain = !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    let value = text.parse().ok().filter(|_| is_plain)?;
    range.contains(&value).then_some(value)
}

/// Days from 1970-01-01 to a date: `2026-11-21`, `2026/11/21`, `21.11.2026`, `11/21/2026` or `21/11/2026`.
fn day_of(text: &str) -> Option<f64> {
    let mark = ['-', '/', '.']
        .into_iter()
        .find(|mark| text.contains(*mark))?;
    let parts: Vec<&str> = text.split(mark).collect();
    let [a, b, c] = parts[..] else { return None };
    let number = |text: &str| whole(text, 0..=9_999);
    let (year, month, day) = match (a.len(), mark) {
        (4, _) => (number(a)?, number(b)?, number(c)?),
        (_, '/') if number(a)? <= 12 => (number(c)?, number(a)?, number(b)?),
        _ => (number(c)?, number(b)?, number(a)?),
    };
    let year = if year < 100 { year + 2_000 } else { year };
    let is_date = (1..=12).contains(&month) && (1..=31).contains(&day);
    is_date.then(|| days_since_1970(year, month, day))
}

/// Days in the Gregorian calendar, with years that begin in March.
fn days_since_1970(year: u32, month: u32, day: u32) -> f64 {
    let year = i64::from(year) - i64::from(month <= 2);
    let month = i64::from((month + 9) % 12);
    let of_year = (153 * month + 2) / 5 + i64::from(day) - 1;
    let leap_days = year / 4 - year / 100 + year / 400;
    (year * 365 + leap_days + of_year - 719_468) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(cells: &[&str]) -> Vec<Option<f64>> {
        let mut times = Times::new(None);
        cells.iter().map(|cell| times.read(cell)).collect()
    }

    fn near(cells: &[&str], expected_s: &[f64]) {
        for (got, expected_s) in read(cells).iter().zip(expected_s) {
            let got = got.unwrap_or_else(|| panic!("{cells:?}"));
            assert!((got - expected_s).abs() < 1e-6, "{cells:?}: {got}");
        }
    }

    #[test]
    fn numbers_are_as_they_are_or_count_from_the_first() {
        near(&["5.5", "5,75"], &[5.5, 5.75]);
        near(&["1795255200.25", "1795255200.5"], &[0.0, 0.25]);
        near(&["1795255200250", "1795255200500"], &[0.0, 0.25]);
        near(
            &["1795255200250000000", "1795255200500000000"],
            &[0.0, 0.25],
        );
        let mut milliseconds = Times::new(Some(Scale::Line {
            factor: 1e-3,
            offset: 0.0,
        }));
        assert_eq!(milliseconds.read("250"), Some(0.25));
    }

    #[test]
    fn dates_and_clocks_count_from_the_first() {
        near(
            &["2026-11-21T10:00:00.250Z", "2026-11-21T10:00:01Z"],
            &[0.0, 0.75],
        );
        near(
            &["2026-12-31 23:59:59,5+01:00", "2027-01-01 00:00:00+01:00"],
            &[0.0, 0.5],
        );
        near(
            &["2026-10-25T02:59:59+02:00", "2026-10-25T02:00:00+01:00"],
            &[0.0, 1.0],
        );
        near(&["28.02.2028 23:59:59", "29.02.2028 00:00:01"], &[0.0, 2.0]);
        near(
            &["11/21/2026 11:59:59 AM", "11/21/2026 12:00:00 PM"],
            &[0.0, 1.0],
        );
        near(
            &["23:59:59.9", "00:00:00.1", "00:00:01.1"],
            &[0.0, 0.2, 1.2],
        );
    }

    #[test]
    fn what_is_no_time_is_none() {
        for cell in [
            "",
            "x",
            "12:",
            "25:00:00",
            "1:2:3:4",
            "2026-13-01 1:00:00",
            "nan",
            "ä:ö",
            "+",
            "10:00:00+é1",
        ] {
            assert_eq!(read(&[cell]), [None], "{cell}");
        }
        assert_eq!(read(&["10:00:00", "5"]), [Some(0.0), None]);
        assert!(is_clock("10:00:00") && !is_clock("10"));
        assert_eq!(days_since_1970(1970, 1, 1), 0.0);
    }
}
