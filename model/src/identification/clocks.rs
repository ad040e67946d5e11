//! What a log's clocks may be off by: each channel against the currents.

use crate::campaign::Channel;
use crate::simulation::Trace;

/// Prior sigma of an offset, s: a channel may be a sample of 20 ms out of step (DATA.md).
pub const OFFSET_PRIOR_S: f64 = 0.008;

/// Clock errors of a campaign.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Clocks {
    /// How late each channel is stamped against the currents, s, by [`Channel::index`].
    pub offsets_s: [f64; 4],
}

impl Clocks {
    /// A simulated trace as channels with these offsets would have been logged at `time_s`.
    pub fn stamp(&self, time_s: &[f64], trace: &mut Trace) {
        for channel in Channel::ALL {
            self.stamp_channel(channel.index(), time_s, trace);
        }
    }

    /// [`Clocks::stamp`] for one channel, by its index.
    pub fn stamp_channel(&self, channel: usize, time_s: &[f64], trace: &mut Trace) {
        let offset_s = self.offsets_s[channel];
        if offset_s != 0.0 && time_s.len() > 1 {
            trace.channels[channel] = later(time_s, &trace.channels[channel], offset_s);
        }
    }
}

/// A record `delay_s` later, by cubic interpolation (Catmull & Rom): a straight line would flatten a pressure that
/// rings with four samples a period. Held between its neighbours, so that the jump of a pump pressure does not spill
/// over.
fn later(time_s: &[f64], values: &[f64], delay_s: f64) -> Vec<f64> {
    let last = values.len() - 1;
    let mut cell = 0;
    (0..=last)
        .map(|sample| {
            let at_s = (time_s[sample] - delay_s).clamp(time_s[0], time_s[last]);
            while cell > 0 && time_s[cell] > at_s {
                cell -= 1;
            }
            while cell + 1 < last && time_s[cell + 1] <= at_s {
                cell += 1;
            }
            let share = (at_s - time_s[cell]) / (time_s[cell + 1] - time_s[cell]);
            let around = [cell.saturating_sub(1), cell, cell + 1, (cell + 2).min(last)];
            let (before, after) = (values[cell], values[cell + 1]);
            catmull_rom(around.map(|k| values[k]), share)
                .max(before.min(after))
                .min(before.max(after))
        })
        .collect()
}

/// Value at `share` of the way from the second to the third of four equidistant points.
fn catmull_rom([a, b, c, d]: [f64; 4], share: f64) -> f64 {
    let (slope_b, slope_c) = (0.5 * (c - a), 0.5 * (d - b));
    let s = share;
    let (s2, s3) = (s * s, s * s * s);
    (2.0 * s3 - 3.0 * s2 + 1.0) * b
        + (s3 - 2.0 * s2 + s) * slope_b
        + (3.0 * s2 - 2.0 * s3) * c
        + (s3 - s2) * slope_c
}
