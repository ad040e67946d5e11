//! Live state of the ECU: a rewritten line on a terminal, otherwise a table.

use std::io::{self, IsTerminal, Write};
use std::time::Duration;

use hitch_quantities::{Fault, State};
use indicatif::{ProgressBar, ProgressStyle};

use crate::ecu::{Moment, PaceChange};

/// Interval between updates of the line, ms.
const LIVE_MS: u64 = 100;
/// Interval between rows of the table, ms; a row is also added when state or fault change.
const ROW_MS: u64 = 1_000;

/// Where the state is shown.
#[derive(Debug)]
pub struct StatusLine {
    bar: Option<ProgressBar>,
    last: Option<(u8, u8)>,
    behind: bool,
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
        let mut line = line(moment, clients);
        if self.behind {
            line.push_str("  behind real time");
        }
        match bar {
            Some(bar) => bar.set_message(line),
            None => {
                let mut output = io::stdout().lock();
                writeln!(output, "{line}")?;
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

fn line(moment: &Moment, clients: Option<usize>) -> String {
    let (signals, reply) = (&moment.signals, &moment.reply);
    let fault = match Fault::from_code(reply.fault) {
        Some(fault) => format!("  fault: {}", fault.name()),
        None => String::new(),
    };
    let clients = clients.map_or(String::new(), |clients| format!("  clients {clients}"));
    format!(
        "{:9.3} s  {:6.2} deg  target {:6.2}  lever {:6.2}  lift {:5.3} A  lower {:5.3} A  {:5.1} bar  {}{fault}{clients}",
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
