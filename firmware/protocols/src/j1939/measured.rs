//! Measured values for loggers: two consecutive groups of the proprietary range.
//!
//! | group | bytes 1, 2 | 3, 4 | 5, 6 | 7, 8 |
//! |---|---|---|---|---|
//! | 65349, hitch motion | lift current | lowering current | rocker angle | time of the sample |
//! | 65350, hitch pressures | cylinder pressure | pump pressure | supply | time of the sample |
//!
//! The currents are means since the previous group. Little-endian, with the scales of `hitch.dbc`; 0xFFFF: not
//! measured. Both groups are of the same sample and carry its time, so the delay of a frame on the bus or in an adapter
//! does not affect computed speeds.

use hitch_quantities::Inputs;
use hitch_quantities::fixed::Divisor;
use hitch_quantities::signals::charge::CoilCharge;
use hitch_quantities::units::{MilliAmp, Millisecond};

use super::id::{GLOBAL, Id, Pgn};
use super::scale::{NOT_AVAILABLE, Scale};
use super::time::since_ms;
use crate::can::Frame;

/// Period of the sample time, milliseconds: below the values that J1939 reserves.
pub const TIME_WRAPS_MS: u32 = 64_000;
/// Priority of proprietary groups.
const PRIORITY: u8 = 6;

/// 1 mA a bit from -32 A.
const CURRENT: Scale = Scale {
    offset: -32_000,
    per_bit: 1,
};
/// 0.01 degree a bit from -200 degrees.
const ANGLE: Scale = Scale {
    offset: -200_000,
    per_bit: 10,
};
/// 0.01 bar a bit from -50 bar.
const PRESSURE: Scale = Scale {
    offset: -50_000,
    per_bit: 10,
};
/// 1 mV a bit.
const VOLTAGE: Scale = Scale {
    offset: 0,
    per_bit: 1,
};

/// The raw value of a measurement.
fn raw(scale: Scale, counts: Option<i32>) -> u16 {
    counts.map_or(NOT_AVAILABLE, |counts| scale.raw(counts))
}

/// The broadcast.
#[derive(Clone, Copy, Debug, Default)]
pub struct MeasuredBroadcast {
    sent_ms: Option<u32>,
    charge_then: CoilCharge,
}

impl MeasuredBroadcast {
    /// The frames that are due; none with a period of 0.
    pub fn poll(
        &mut self,
        source: u8,
        now_ms: u32,
        period: Millisecond,
        inputs: &Inputs,
        charge: CoilCharge,
    ) -> Option<[Frame; 2]> {
        let period_ms = u32::try_from(period.0).ok().filter(|&period| period > 0)?;
        let passed_ms = self.sent_ms.map_or(now_ms, |sent| since_ms(sent, now_ms));
        if self.sent_ms.is_some() && passed_ms < period_ms {
            return None;
        }
        let steps = Divisor::at_least_one(passed_ms.cast_signed());
        let means = charge.mean_since(self.charge_then, steps);
        (self.sent_ms, self.charge_then) = (Some(now_ms), charge);
        Some(frames(source, now_ms, inputs, means))
    }
}

fn frames(source: u8, now_ms: u32, inputs: &Inputs, [lift, lower]: [MilliAmp; 2]) -> [Frame; 2] {
    let time = u16::try_from(now_ms % TIME_WRAPS_MS).unwrap_or(NOT_AVAILABLE);
    let motion = [
        raw(CURRENT, inputs.lift_current.map(|_| lift.0)),
        raw(CURRENT, inputs.lower_current.map(|_| lower.0)),
        raw(ANGLE, inputs.rocker_angle.map(|value| value.0)),
        time,
    ];
    let pressures = [
        raw(PRESSURE, inputs.cylinder_pressure.map(|value| value.0)),
        raw(PRESSURE, inputs.pump_pressure.map(|value| value.0)),
        raw(VOLTAGE, inputs.supply.map(|value| value.0)),
        time,
    ];
    let groups = [
        (Pgn::HITCH_MOTION, motion),
        (Pgn::HITCH_PRESSURES, pressures),
    ];
    groups.map(|(pgn, quantities)| {
        let [[a, b], [c, d], [e, f], [g, h]] = quantities.map(u16::to_le_bytes);
        let id = Id {
            priority: PRIORITY,
            pgn,
            destination: GLOBAL,
            source,
        };
        id.frame([a, b, c, d, e, f, g, h])
    })
}
