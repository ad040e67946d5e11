//! What the parts of a step take: both valve maps, and the regulation of both coils' currents.

use core::hint::black_box;

use hitch_firmware::control::current::Regulation;
use hitch_firmware::control::safety::CoilCurrents;
use hitch_firmware::control::units::{MicroLitrePerSecond, MilliAmp, MilliBar, MilliVolt};
use hitch_firmware::control::valve_map::{DropScale, ValveMap};
use hitch_firmware::control::{Calibration, Inputs};

use crate::Failure;
use crate::console::{Word, say};
use crate::stopwatch::Stopwatch;

/// From no flow to beyond saturation, ul/s.
const FLOWS: core::ops::RangeInclusive<i32> = 0..=1_000_000;
const FLOW_STEP: usize = 997;

/// Says the most ticks that each part took. Not merged into its caller, whose stack it would take for good.
#[inline(never)]
pub fn run(stopwatch: &Stopwatch) -> Result<(), Failure> {
    let calibration = Calibration::nominal().validate()?;
    let reference = calibration.hydraulics.reference_drop;
    let (mut lift, mut lower, mut scale) = (0, 0, 0);
    for flow in FLOWS.step_by(FLOW_STEP) {
        let drop = MilliBar(1_000 + flow / 5);
        let (present, ticks) =
            stopwatch.ticks_of(|| DropScale::new(black_box(reference), black_box(drop)));
        scale = ticks.max(scale);
        let map = ValveMap {
            lift: &calibration.lift,
            lower: &calibration.lower,
            scale: present,
        };
        let flow = MicroLitrePerSecond(flow);
        let (_, ticks) = stopwatch.ticks_of(|| black_box(&map).lift_current(black_box(flow)));
        lift = ticks.max(lift);
        let (_, ticks) = stopwatch.ticks_of(|| black_box(&map).lower_current(black_box(flow)));
        lower = ticks.max(lower);
    }
    let mut regulation = Regulation::new(&calibration.current);
    let mut both_coils = 0;
    for step in 0..2_000 {
        let asked = CoilCurrents {
            lift: MilliAmp(step / 100 * 150),
            lower: MilliAmp::ZERO,
        };
        let inputs = Inputs {
            supply: Some(MilliVolt(13_800)),
            lift_current: Some(MilliAmp(step / 100 * 150 - step % 100)),
            lower_current: Some(MilliAmp::ZERO),
            ..Inputs::default()
        };
        let (_, ticks) = stopwatch.ticks_of(|| {
            regulation.drive(black_box(asked), black_box(&inputs), &calibration.current)
        });
        both_coils = ticks.max(both_coils);
    }
    for (name, ticks) in [
        ("lift_map=", lift),
        ("lower_map=", lower),
        ("drop_scale=", scale),
        ("regulation=", both_coils),
    ] {
        say(&[Word::Text(name), Word::Number(ticks), Word::Text("\n")]);
    }
    Ok(())
}
