//! The groups of measured values, 65349 and 65350: two frames of the same sample.

use hitch_protocols::j1939::Pgn;

/// Largest raw value of a two-byte quantity that is data.
const LARGEST: u16 = 0xFAFF;

/// Measured values of one sample; `None`: not measured, or not received.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Measured {
    /// Current of the lift coil, A.
    pub lift_a: Option<f64>,
    /// Current of the lowering coil, A.
    pub lower_a: Option<f64>,
    /// Rocker angle, degree.
    pub angle_deg: Option<f64>,
    /// Pressure in the cylinder, bar.
    pub cylinder_bar: Option<f64>,
    /// Pressure of the pump, bar.
    pub pump_bar: Option<f64>,
}

/// Combines the frames of a sample.
#[derive(Debug, Default)]
pub struct SamplePairs {
    /// Time of the ECU, ms, of the sample that lacks a frame, the group that it has, and its values.
    half: Option<(u16, Pgn, Measured)>,
}

impl SamplePairs {
    /// Processes a frame of either group; returns samples with their time, ms of the ECU, in their order. A sample whose
    /// other frame was lost is incomplete, and is returned after the next one has begun.
    pub fn receive(&mut self, group: Pgn, bytes: &[u8; 8]) -> [Option<(u16, Measured)>; 2] {
        let [a, b, c, d, e, f, g, h] = *bytes;
        let time_ms = u16::from_le_bytes([g, h]);
        let [first, second, third] = [[a, b], [c, d], [e, f]].map(u16::from_le_bytes);
        let (other, begun) = match self.half.take() {
            Some((of_ms, has, values)) if of_ms == time_ms && has != group => (None, Some(values)),
            Some((of_ms, _, values)) => (Some((of_ms, values)), None),
            None => (None, None),
        };
        let is_complete = begun.is_some();
        let mut values = begun.unwrap_or_default();
        if group == Pgn::HITCH_MOTION {
            values.lift_a = scaled(first, 32_000.0, 1_000.0);
            values.lower_a = scaled(second, 32_000.0, 1_000.0);
            values.angle_deg = scaled(third, 20_000.0, 100.0);
        } else {
            values.cylinder_bar = scaled(first, 5_000.0, 100.0);
            values.pump_bar = scaled(second, 5_000.0, 100.0);
        }
        if !is_complete {
            self.half = Some((time_ms, group, values));
        }
        [other, is_complete.then_some((time_ms, values))]
    }
}

/// A value in its unit, with the scale of `firmware/hitch.dbc`: the raw value of zero, and the bits of a unit.
fn scaled(raw: u16, zero: f64, bits_per_unit: f64) -> Option<f64> {
    (raw <= LARGEST).then_some((f64::from(raw) - zero) / bits_per_unit)
}

#[cfg(test)]
mod tests {
    use super::*;
    use hitch_protocols::can::Frame;
    use hitch_protocols::j1939::{Id, MeasuredBroadcast};
    use hitch_quantities::Inputs;
    use hitch_quantities::signals::charge::CoilCharge;
    use hitch_quantities::units::{MilliAmp, MilliBar, MilliDegree, Millisecond};

    fn sent(now_ms: u32) -> [Frame; 2] {
        let inputs = Inputs {
            rocker_angle: Some(MilliDegree(93_450)),
            lift_current: Some(MilliAmp(0)),
            lower_current: None,
            cylinder_pressure: Some(MilliBar(123_450)),
            pump_pressure: Some(MilliBar(-1_000)),
            ..Inputs::default()
        };
        let (period, charge) = (Millisecond(20), CoilCharge::default());
        let frames = MeasuredBroadcast::default().poll(0x80, now_ms, period, &inputs, charge);
        frames.expect("it is due")
    }

    fn received(pairs: &mut SamplePairs, frame: &Frame) -> Vec<(u16, Measured)> {
        let group = Id::unpack(frame.extended_data_id().unwrap()).pgn;
        let samples = pairs.receive(group, frame.eight().unwrap());
        samples.into_iter().flatten().collect()
    }

    fn near(value: Option<f64>, expected: f64) -> bool {
        value.is_some_and(|value| (value - expected).abs() < 1e-9)
    }

    #[test]
    fn the_frames_of_the_firmware_are_one_sample() {
        let mut pairs = SamplePairs::default();
        let [motion, pressures] = sent(64_040);
        assert_eq!(received(&mut pairs, &motion), []);
        let samples = received(&mut pairs, &pressures);
        let [(time_ms, values)] = samples[..] else {
            panic!("{samples:?}");
        };
        assert_eq!((time_ms, values.lower_a), (40, None));
        assert!(
            near(values.angle_deg, 93.45) && near(values.lift_a, 0.0),
            "{values:?}"
        );
        assert!(
            near(values.cylinder_bar, 123.45) && near(values.pump_bar, -1.0),
            "{values:?}"
        );
    }

    #[test]
    fn a_sample_with_a_lost_frame_lacks_its_values_and_takes_no_others() {
        let mut pairs = SamplePairs::default();
        let [motion, _] = sent(20);
        let [next, pressures] = sent(40);
        received(&mut pairs, &motion);
        let lost = received(&mut pairs, &next);
        assert_eq!(lost.len(), 1);
        assert!(
            lost[0].0 == 20 && lost[0].1.pump_bar.is_none() && near(lost[0].1.angle_deg, 93.45)
        );
        let whole = received(&mut pairs, &pressures);
        assert!(whole[0].0 == 40 && near(whole[0].1.pump_bar, -1.0));
    }
}
