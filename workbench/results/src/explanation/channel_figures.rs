//! Errors and delay of one channel.

use indexmap::IndexMap;
use schemars::JsonSchema;
use serde::Serialize;

use hitch_output::text::{joined, known};

/// Key of the sum of the contributions to a delay.
pub(super) const SUM: &str = "sum";
/// Key of the clock offset among the contributions to a delay.
pub(super) const CLOCK: &str = "clock";

/// Errors and delay of one channel; the errors are in the channel's unit, which is the end of its key.
///
/// The weighted error is the error in sigma of `hitch compare` times the noise. It weights slow drifts, which a simulation
/// accumulates, by the accuracy with which it can follow them; the raw error does not.
#[derive(Debug, Clone, Serialize, JsonSchema)]
pub struct ChannelFigures {
    /// Weighted error of the initial model, in the channel's unit; `null` if no sample was compared.
    #[schemars(with = "Option<f64>")]
    pub before: f64,
    /// Weighted error of the final model, in the channel's unit; `null` if no sample was compared.
    #[schemars(with = "Option<f64>")]
    pub after: f64,
    /// Root mean square of measured - simulated by the initial model, in the channel's unit; `null` if no sample was
    /// compared.
    #[schemars(with = "Option<f64>")]
    pub rms_before: f64,
    /// Root mean square of measured - simulated by the final model, in the channel's unit; `null` if no sample was compared.
    #[schemars(with = "Option<f64>")]
    pub rms_after: f64,
    /// Noise of the instrument, one sigma, in the channel's unit.
    pub noise: f64,
    /// Offset of the channel's clock relative to the currents, s; positive if the channel is late.
    #[schemars(with = "Option<f64>")]
    pub late_s: f64,
    /// Contributions to the channel's delay behind the currents, s: `clock` is the clock offset, `declared spool lag`
    /// that of the model, ids of effects their time constants, and `sum` is the sum of all.
    pub delay_s: IndexMap<&'static str, f64>,
}

impl ChannelFigures {
    /// The figures as the cells of a table: weighted errors in sigma, raw errors, noise, clock offset.
    #[must_use]
    pub fn cells(&self) -> [String; 6] {
        let [before, after] = self.sigmas().map(|error| known(error, 2));
        [
            before,
            after,
            known(self.rms_before, 3),
            known(self.rms_after, 3),
            known(self.noise, 3),
            self.late_ms(),
        ]
    }

    /// Weighted errors before and after, in sigma.
    #[must_use]
    pub fn sigmas(&self) -> [f64; 2] {
        [self.before, self.after].map(|error| error / self.noise)
    }

    /// Headings of [`ChannelFigures::cells`].
    pub const HEADINGS: [&'static str; 6] = [
        "sigma before",
        "after",
        "rms before",
        "after",
        "noise",
        "offset, ms",
    ];

    /// Offset of the channel's clock relative to the currents, ms, as text.
    #[must_use]
    pub fn late_ms(&self) -> String {
        // Less than half a millisecond is displayed as none.
        let late_ms = (1e3 * self.late_s).round() + 0.0;
        if late_ms.is_finite() {
            format!("{late_ms:.0}")
        } else {
            "-".to_owned()
        }
    }

    /// The delay behind the currents with its contributions, ms, as text; `None` if the clock offset is the only one.
    #[must_use]
    pub fn delay_ms(&self) -> Option<String> {
        let parts = &self.delay_s;
        let is_effect = |name: &&&str| ![SUM, CLOCK].contains(*name);
        parts.keys().find(is_effect)?;
        let named = parts.iter().filter(|(name, _)| **name != SUM);
        let said = |name: &'static str| match name {
            CLOCK => "clock of the log",
            other => other,
        };
        let terms = named.map(|(name, part_s)| format!("{}: {:+.0}", said(name), 1e3 * part_s));
        let sum_ms = 1e3 * parts.get(SUM).copied().unwrap_or(f64::NAN);
        Some(format!("{sum_ms:.0} ms ({})", joined(terms, ", ")))
    }
}
