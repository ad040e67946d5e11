//! Times of a log: seconds and their multiples, epoch times, dates and times of day.

use chrono::{DateTime, Datelike as _, NaiveDate, NaiveTime, Timelike as _};

use crate::csv_log::decimals::Decimals;
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
    order: DateOrder,
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
    /// For a log with this time unit, if known, and dates in this order.
    pub fn new(scale: Option<Scale>, order: DateOrder) -> Self {
        let unit_s = match scale {
            Some(Scale::Line { factor, .. }) => Some(factor),
            _ => None,
        };
        Self {
            unit_s,
            order,
            begin: None,
            last: (f64::NEG_INFINITY, 0.0),
        }
    }

    /// The time in a cell, s; epoch and clock times are relative to the first one. `None` if the cell contains no time.
    pub fn read(&mut self, cell: &str) -> Option<f64> {
        match number(cell) {
            Some(number) => self.of_number(number),
            None => self.of_clock(parse(cell, self.order)?),
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

    /// The time of the clock at time 0, s; zero without an absolute one.
    pub fn origin_s(&self) -> f64 {
        match self.begin {
            Some(Begin::Number { first, unit_s }) => first * unit_s,
            Some(Begin::Clock { first_s }) => first_s,
            None => 0.0,
        }
    }

    /// How much later the first of these times is than that of others, s; zero unless both are absolute.
    pub fn later_than_s(&self, other: &Self) -> f64 {
        let (own_s, other_s) = (self.origin_s(), other.origin_s());
        let are_absolute = own_s != 0.0 && other_s != 0.0;
        if are_absolute { own_s - other_s } else { 0.0 }
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
    let number = Decimals::ANY.number(cell);
    number.filter(|number| number.is_finite())
}

/// Whether a cell contains a date or a time of day.
pub fn is_clock(cell: &str) -> bool {
    is_in_an_order(cell, |order| parse(cell, order).is_some())
}

/// Whether a cell contains a date without a time of day.
pub fn is_date(cell: &str) -> bool {
    is_in_an_order(cell, |order| day_of(cell, order).is_some())
}

/// Whether a cell is no number, and `is_of` an order of day and month.
fn is_in_an_order(cell: &str, is_of: impl Fn(DateOrder) -> bool) -> bool {
    number(cell).is_none() && (is_of(DateOrder::DayFirst) || is_of(DateOrder::MonthFirst))
}

/// A date and time, or a time of day.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Instant {
    /// Days since 1970-01-01, if there is a date.
    day: Option<f64>,
    /// Seconds since midnight.
    of_day_s: f64,
}

/// Order of day and month in dates like `12/11/2026`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum DateOrder {
    /// Day, month, year.
    #[default]
    DayFirst,
    /// Month, day, year.
    MonthFirst,
}

impl DateOrder {
    /// The order as a reader knows it.
    pub fn name(self) -> &'static str {
        match self {
            Self::DayFirst => "day/month/year",
            Self::MonthFirst => "month/day/year",
        }
    }

    /// The order of a column: the one in which all dates exist and the longest step between them is the shorter one; and
    /// whether the other one would give other times.
    pub fn of<'c>(cells: impl Iterator<Item = &'c str>) -> (Self, bool) {
        let mut dates: Vec<&str> = cells.filter_map(|cell| Some(split(cell)?.0)).collect();
        dates.dedup();
        let longest_step = |order: Self| {
            let days: Option<Vec<f64>> = dates.iter().map(|date| day_of(date, order)).collect();
            let days = days.unwrap_or_else(|| vec![f64::NEG_INFINITY, f64::INFINITY]);
            let steps = days.windows(2).map(|pair| (pair[1] - pair[0]).abs());
            steps.fold(0.0, f64::max)
        };
        let [day, month] = [Self::DayFirst, Self::MonthFirst].map(longest_step);
        let order = if month < day {
            Self::MonthFirst
        } else {
            Self::DayFirst
        };
        (order, day != month)
    }
}

/// Splits a cell into its date, which may be empty, and its time of day, which begins with the digits before the first colon.
fn split(cell: &str) -> Option<(&str, &str)> {
    let colon = cell.find(':')?;
    let hour = cell[..colon].trim_end_matches(|c: char| c.is_ascii_digit());
    let date = hour.trim_end_matches(['T', 't', ' ', ',', '_', '-']);
    Some((date.trim(), &cell[hour.len()..]))
}

/// Reads a date with a time of day, a time of day alone, or a number of days before it, as pandas writes a duration.
fn parse(cell: &str, order: DateOrder) -> Option<Instant> {
    let (date, clock) = split(cell)?;
    let days = date.strip_suffix("days").map(str::trim_end);
    let day = match (date, days) {
        ("", _) => None,
        (_, Some(days)) => Some(f64::from(days.parse::<i32>().ok()?)),
        (date, None) => Some(day_of(date, order)?),
    };
    let of_day_s = of_day_s(clock)?;
    Some(Instant { day, of_day_s })
}

/// Parses `10:00:00.123`, followed by `AM` or `PM`, `Z` or an offset.
fn of_day_s(text: &str) -> Option<f64> {
    const FORMS: [&str; 6] = [
        "%H:%M:%S%.f",
        "%H:%M:%S:%3f",
        "%H:%M",
        "%I:%M:%S%.f%p",
        "%I:%M:%S:%3f%p",
        "%I:%M%p",
    ];
    let text = text.trim_end_matches(['Z', 'z']).trim_end();
    let (clock, offset_s) = match text.find(['+', '-']) {
        Some(sign) => (&text[..sign], offset_s(&text[sign..])?),
        None => (text, 0.0),
    };
    let clock = clock.replace(',', ".").replace(' ', "");
    let read = |form: &&str| NaiveTime::parse_from_str(&clock, form).ok();
    let time = FORMS.iter().find_map(read)?;
    let seconds = f64::from(time.num_seconds_from_midnight());
    Some(seconds + f64::from(time.nanosecond()) * 1e-9 - offset_s)
}

/// Parses an offset: `+01:00`, `-0530`, `+01`.
fn offset_s(text: &str) -> Option<f64> {
    let full = match text.len() {
        3 => format!("{text}00"),
        _ => text.to_owned(),
    };
    let whole = format!("2000-01-01T00:00:00{full}");
    let read = DateTime::parse_from_str(&whole, "%Y-%m-%dT%H:%M:%S%z").ok()?;
    Some(f64::from(read.offset().local_minus_utc()))
}

/// Days from 1970-01-01 to a date: `2026-11-21`, `20261121`, `21.11.2026`, `11/21/2026`, `21-Nov-2026`, `Nov 21, 2026`.
fn day_of(text: &str, order: DateOrder) -> Option<f64> {
    const BY_NAME: [&str; 4] = ["%d %b %Y", "%b %d %Y", "%a %d %b %Y", "%a %b %d %Y"];
    const OF_EPOCH: NaiveDate = NaiveDate::from_ymd_opt(1970, 1, 1).expect("a date");
    const CENTURY: i32 = 2_000;
    let words: Vec<&str> = text
        .split(['-', '/', '.', ',', ' '])
        .filter(|word| !word.is_empty())
        .collect();
    let is_digits = |word: &&str| word.bytes().all(|byte| byte.is_ascii_digit());
    let forms: &[&str] = match (words.first()?.len(), order) {
        _ if !words.iter().all(is_digits) => &BY_NAME,
        (8, _) => &["%Y%m%d"],
        (4, _) => &["%Y %m %d"],
        (_, DateOrder::MonthFirst) if !text.contains('.') => &["%m %d %Y"],
        _ => &["%d %m %Y"],
    };
    let words = words.join(" ");
    let read = |form: &&str| NaiveDate::parse_from_str(&words, form).ok();
    let date = forms.iter().find_map(read)?;
    let date = match date.year() {
        year @ 0..100 => date.with_year(CENTURY + year)?,
        _ => date,
    };
    Some((date - OF_EPOCH).num_days() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(cells: &[&str]) -> Vec<Option<f64>> {
        let (order, _) = DateOrder::of(cells.iter().copied());
        let mut times = Times::new(None, order);
        cells.iter().map(|cell| times.read(cell)).collect()
    }

    fn near(cells: &[&str], expected_s: &[f64]) {
        for (got, expected_s) in read(cells).iter().zip(expected_s) {
            let got = got.unwrap_or_else(|| panic!("{cells:?}"));
            assert!((got - expected_s).abs() < 1e-6, "{cells:?}: {got}");
        }
    }

    #[test]
    fn durations_begin_with_days() {
        near(
            &["0 days 00:00:00", "0 days 00:01:00.020000"],
            &[0.0, 60.02],
        );
        near(&["0 days 23:59:59.5", "1 days 00:00:00"], &[0.0, 0.5]);
        assert_eq!(read(&["9 dogs 00:00:00", "days 00:00:00"]), [None, None]);
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
        let scale = Scale::Line {
            factor: 1e-3,
            offset: 0.0,
        };
        let mut milliseconds = Times::new(Some(scale), DateOrder::default());
        assert_eq!(milliseconds.read("250"), Some(0.25));
    }

    #[test]
    fn dates_and_clocks_count_from_the_first() {
        for (first, second, step_s) in [
            ("2026-11-21T10:00:00.250Z", "2026-11-21T10:00:01Z", 0.75),
            (
                "2026-12-31 23:59:59,5+01:00",
                "2027-01-01 00:00:00+01:00",
                0.5,
            ),
            (
                "2026-10-25T02:59:59+02:00",
                "2026-10-25T02:00:00+01:00",
                1.0,
            ),
            ("28.02.2028 23:59:59", "29.02.2028 00:00:01", 2.0),
            ("11/21/2026 11:59:59 AM", "11/21/2026 12:00:00 PM", 1.0),
            ("21-Nov-2026 23:59:59.750", "22-Nov-2026 00:00:00.250", 0.5),
            ("21/11/2026 23:59:59:750", "22/11/2026 00:00:00:250", 0.5),
            ("12/11/2026 23:59:59.750", "12/12/2026 00:00:00.250", 0.5),
            ("12/11/2026 23:59:59.750", "13/11/2026 00:00:00.250", 0.5),
            ("20261121T23:59:59,75", "20261122T00:00:00,25", 0.5),
            (
                "Sat, 21 Nov 2026 23:59:59",
                "Sun, 22 Nov 2026 00:00:00.5",
                1.5,
            ),
            ("21.11.26 23:59:59,75", "22.11.26 00:00:00,25", 0.5),
        ] {
            near(&[first, second], &[0.0, step_s]);
        }
        near(
            &["23:59:59.9", "00:00:00.1", "00:00:01.1"],
            &[0.0, 0.2, 1.2],
        );
    }

    #[test]
    fn the_dates_tell_the_order_of_day_and_month() {
        use DateOrder::{DayFirst, MonthFirst};
        for (first, second, order) in [
            ("12/11/2026 1:00:00", "13/11/2026 1:00:00", (DayFirst, true)),
            (
                "11/12/2026 1:00:00",
                "11/13/2026 1:00:00",
                (MonthFirst, true),
            ),
            ("11/11/2026 1:00:00", "12/11/2026 1:00:00", (DayFirst, true)),
            (
                "11/11/2026 1:00:00",
                "11/12/2026 1:00:00",
                (MonthFirst, true),
            ),
            // Of one date either order is right.
            (
                "12/11/2026 1:00:00",
                "12/11/2026 2:00:00",
                (DayFirst, false),
            ),
        ] {
            assert_eq!(
                DateOrder::of([first, second].into_iter()),
                order,
                "{second}"
            );
        }
        assert!(is_date("21.11.2026") && is_date("11/21/2026") && !is_date("10:00:00"));
    }

    #[test]
    fn what_is_no_time_is_none() {
        let cells = "|x|12:|25:00:00|1:2:3:4|2026-13-01 1:00:00|nan|ä:ö|+|10:00:00+é1";
        for cell in cells.split('|') {
            assert_eq!(read(&[cell]), [None], "{cell}");
        }
        assert_eq!(read(&["10:00:00", "5"]), [Some(0.0), None]);
        assert!(is_clock("10:00:00") && !is_clock("10"));
        assert_eq!(day_of("1970-01-01", DateOrder::DayFirst), Some(0.0));
    }
}
