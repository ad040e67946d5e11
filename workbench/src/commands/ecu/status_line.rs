//! Live state of the ECU: a rewritten line on a terminal, otherwise a table.

use std::io::{self, IsTerminal, Write};
use std::time::Duration;

use hitch_quantities::{Fault, State};
use indicatif::{ProgressBar, ProgressStyle};

use hitch_ecu_host::ecu::{Moment, PaceChange};
use hitch_output::text::width;

/// Interval between updates of the line, ms.
const LIVE_MS: u64 = 100;
/// Interval between rows of the table, ms; a row is also added when state or fault change.
const ROW_MS: u64 = 1_000;

/// Header of the rows.
const HEAD: &str = "  time s    deg target  lever lift A low. A   bar  state";

/// Indentation of the second line of a row that is too long.
const SECOND: &str = "          ";

/// Where the state is shown.
#[derive(Debug)]
pub struct StatusLine {
    bar: Option<ProgressBar>,
    last: Option<(u8, u8)>,
    behind: bool,
    has_head: bool,
}

impl StatusLine {
    /// Selects the form by the type of standard output.
    pub fn start() -> Self {
        let bar = (io::stdout().is_terminal() && io::stderr().is_terminal()).then(|| {
            let bar = ProgressBar::new_spinner();
            if let Ok(style) = ProgressStyle::with_template("{spinner} {msg}") {
                bar.set_style(style);
            }
            bar.enable_steady_tick(Duration::from_millis(120));
            bar
        });
        Self {
            bar,
            last: None,
            behind: false,
            has_head: false,
        }
    }

    /// Shows a millisecond if the interval has passed or the state has changed.
    ///
    /// # Errors
    /// If standard output cannot be written.
    pub fn show(&mut self, moment: &Moment, clients: Option<usize>) -> io::Result<()> {
        let now = (moment.reply.state, moment.reply.fault);
        let changed = self.last.replace(now) != Some(now);
        let (bar, period_ms) = match &self.bar {
            Some(bar) => (Some(bar), LIVE_MS),
            None => (None, ROW_MS),
        };
        if !changed && !moment.time_ms.is_multiple_of(period_ms) {
            return Ok(());
        }
        let notes = notes(moment, clients, self.behind);
        let has_head = std::mem::replace(&mut self.has_head, true);
        match bar {
            Some(bar) => {
                // The spinner takes two columns.
                if !has_head {
                    bar.println(format!("  {HEAD}"));
                }
                bar.set_message(row(moment) + &notes.concat());
            }
            None => {
                let mut output = io::stdout().lock();
                if !has_head {
                    writeln!(output, "{HEAD}")?;
                }
                writeln!(output, "{}", fitted(row(moment), &notes, width()))?;
                output.flush()?;
            }
        }
        Ok(())
    }

    /// Shows from now on whether the bench is behind real time; standard error gets a line if there is no terminal.
    pub fn tell(&mut self, change: PaceChange) {
        self.behind = change == PaceChange::FallsBehind;
        if self.bar.is_none() {
            eprintln!(
                "{}",
                match change {
                    PaceChange::FallsBehind => {
                        "behind real time: this computer is too slow or busy; times on the bus are too long"
                    }
                    PaceChange::KeepsUp => "in real time again",
                }
            );
        }
    }

    /// Prints a message beside the state.
    pub fn say(&self, what: &str) {
        match &self.bar {
            Some(bar) => bar.println(what),
            None => eprintln!("{what}"),
        }
    }
}

impl Drop for StatusLine {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

/// The figures and the state.
fn row(moment: &Moment) -> String {
    let (signals, reply) = (&moment.signals, &moment.reply);
    format!(
        "{:8.2} {:6.2} {:6.2} {:6.2} {:6.3} {:6.3} {:5.1}  {}",
        moment.time_ms as f64 * 1e-3,
        signals.rocker_angle_deg,
        f64::from(reply.target_mdeg) * 1e-3,
        signals.lever_deg,
        signals.lift_current_a,
        signals.lower_current_a,
        signals.cylinder_pressure_bar,
        State::from_code(reply.state).map_or("?", State::name),
    )
}

/// What follows the state, each with a distance before it.
fn notes(moment: &Moment, clients: Option<usize>, is_behind: bool) -> Vec<String> {
    let fault =
        Fault::from_code(moment.reply.fault).map(|fault| format!("  fault: {}", fault.name()));
    let clients = clients.map(|clients| format!("  clients {clients}"));
    let behind = is_behind.then(|| "  behind real time".to_owned());
    [fault, clients, behind].into_iter().flatten().collect()
}

/// A row with its notes, the last ones on a second line if it is too long.
fn fitted(mut row: String, notes: &[String], width: usize) -> String {
    let mut length = row.chars().count();
    for note in notes {
        if length + note.chars().count() > width {
            row.push('\n');
            row.push_str(SECOND);
            length = SECOND.len();
        }
        row.push_str(note);
        length += note.chars().count();
    }
    row
}

#[cfg(test)]
mod tests {
    use super::fitted;

    #[test]
    fn notes_that_do_not_fit_are_on_a_second_line() {
        let notes = ["  fault".to_owned(), "  clients 1".to_owned()];
        assert_eq!(
            fitted("row".to_owned(), &notes, 21),
            "row  fault  clients 1"
        );
        assert_eq!(
            fitted("row".to_owned(), &notes, 20),
            "row  fault\n            clients 1"
        );
    }
}
