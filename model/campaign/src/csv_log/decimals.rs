//! The decimal mark of a text table, and the separator of its thousands.

/// The decimal mark.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Decimals {
    point: bool,
    comma: bool,
    /// Separator of thousands, if there is one.
    thousands: Option<char>,
}

/// Separators of thousands.
const THOUSANDS: [char; 6] = ['.', ',', ' ', '\'', '\u{a0}', '\u{202f}'];

impl Decimals {
    /// Either mark.
    pub const ANY: Self = Self {
        point: true,
        comma: true,
        thousands: None,
    };

    /// Determined from the cells of the first rows.
    pub fn of<'r>(cells: impl Iterator<Item = &'r str>) -> Self {
        let (mut points, mut commas) = (0, 0);
        for cell in cells.filter(|cell| Self::ANY.number(cell).is_some()) {
            points += usize::from(cell.contains('.'));
            commas += usize::from(cell.contains(','));
        }
        // A few cells with the other mark are faults, which have to be reported.
        Self {
            point: points >= commas,
            comma: commas > points || points == 0,
            thousands: None,
        }
    }

    /// Those of a column, whose thousands may be separated; the separator, if so.
    ///
    /// A separator is one if each of them precedes three digits, and numbers below a thousand have none.
    pub fn of_column(self, cells: &[&str]) -> (Self, Option<char>) {
        let found = THOUSANDS.into_iter().find(|&mark| {
            let (marked, plain): (Vec<&str>, Vec<&str>) =
                cells.iter().partition(|cell| cell.contains(mark));
            let is_below = |cell: &&str| {
                let whole = cell.split(['.', ',']).next().unwrap_or_default();
                whole.trim_start_matches('-').len() <= 3
            };
            // Where the other mark is the decimal one, or a gap separates, there is no doubt.
            let is_sure = match mark {
                '.' => !self.point,
                ',' => !self.comma,
                _ => true,
            };
            !marked.is_empty()
                && marked.iter().all(|cell| is_grouped(cell, mark))
                && plain.iter().all(is_below)
                && (is_sure || plain.iter().any(|cell| self.number(cell).is_some()))
        });
        let decimals = Self {
            point: self.point || found == Some(','),
            comma: self.comma || found == Some('.'),
            thousands: found,
        };
        (decimals, found)
    }

    /// The number in a cell, possibly infinite; `None` without digits.
    pub fn number(self, cell: &str) -> Option<f64> {
        if is_missing(cell) {
            return None;
        }
        if let Some(mark) = self.thousands {
            let plain = cell.replace(mark, "");
            let is_right = !cell.contains(mark) || is_grouped(cell, mark);
            return Self {
                thousands: None,
                ..self
            }
            .number(&plain)
            .filter(|_| is_right);
        }
        match (cell.contains(','), cell.contains('.')) {
            (true, false) if self.comma => cell.replacen(',', ".", 1).parse().ok(),
            (false, true) if self.point => cell.parse().ok(),
            (false, false) => cell.parse().ok(),
            _ => None,
        }
    }
}

/// Whether a cell contains no value: no digits, or an error of a spreadsheet or of Windows (`#DIV/0!`, `-1.#IND`).
pub fn is_missing(cell: &str) -> bool {
    cell.contains('#') || !cell.bytes().any(|byte| byte.is_ascii_digit())
}

/// Whether a number has a mark before each three digits of its whole part, as in `1.234.567` and `1,234.5`.
fn is_grouped(cell: &str, mark: char) -> bool {
    let cell = cell.trim_start_matches(['-', '+']);
    let whole = match mark {
        '.' => cell.split(',').next(),
        ',' => cell.split('.').next(),
        _ => cell.split(['.', ',']).next(),
    };
    let mut groups = whole.unwrap_or_default().split(mark);
    let is_digits = |group: &str| group.bytes().all(|byte| byte.is_ascii_digit());
    let first = groups.next().unwrap_or_default();
    let mut rest = groups.peekable();
    (1..=3).contains(&first.len())
        && is_digits(first)
        && !first.starts_with('0')
        && rest.peek().is_some()
        && rest.all(|group| group.len() == 3 && is_digits(group))
}
