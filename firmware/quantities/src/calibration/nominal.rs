//! The calibration of an untaught machine: the manufacturer's valve curves and the rig's linkage.

use super::linkage::{LINKAGE_POINTS, LinkageTable};
use super::valve_table::{VALVE_POINTS, ValvePoint, ValveTable};
use crate::units::{MicroLitrePerSecond, Micrometre, MilliAmp, MilliDegree};

/// Lift valve: current in mA and flow in thousandths of l/min at the compensated drop, the points of
/// the manufacturer's curve from the last without flow to the first with all of it.
const LIFT_CURVE: [(i32, i32); 9] = [
    (1_126, 0),
    (1_138, 143),
    (1_568, 8_128),
    (1_974, 15_829),
    (2_319, 22_389),
    (2_640, 28_521),
    (2_858, 32_513),
    (3_070, 36_506),
    (3_252, 39_929),
];

/// Lowering valve at 15 bar, as above. The flat foot up to 1.54 A is the valve's metering notch.
const LOWER_CURVE: [(i32, i32); 16] = [
    (999, 0),
    (1_017, 321),
    (1_042, 642),
    (1_072, 963),
    (1_138, 1_176),
    (1_502, 2_674),
    (1_544, 2_888),
    (1_574, 3_422),
    (1_744, 9_840),
    (2_035, 20_535),
    (2_271, 29_198),
    (2_567, 40_214),
    (3_022, 57_005),
    (3_040, 57_754),
    (3_070, 58_289),
    (3_119, 58_717),
];

/// Piston travel in um, 2 degrees apart from 44 degrees: horizontal cylinder 95 mm below the rocker
/// shaft, connecting rod 220 mm, rocker arm 110 mm, zero at the lower end (44.095 degrees).
#[rustfmt::skip]
const TRAVEL: [i32; LINKAGE_POINTS] = [
    -116, 2_385, 5_020, 7_780, 10_659, 13_650, 16_746, 19_940,
    23_225, 26_593, 30_038, 33_552, 37_129, 40_761, 44_443, 48_167,
    51_926, 55_715, 59_527, 63_357, 67_198, 71_045, 74_893, 78_736,
    82_571, 86_392, 90_194, 93_975, 97_730, 101_456, 105_149, 108_807,
    112_427, 116_006, 119_542, 123_034, 126_479, 129_877, 133_225, 136_522,
    139_769, 142_963, 146_105, 149_193, 152_228, 155_210, 158_139,
];

/// Lift valve of an untaught machine.
pub const LIFT: ValveTable = table(&LIFT_CURVE);
/// Lowering valve of an untaught machine.
pub const LOWER: ValveTable = table(&LOWER_CURVE);
/// Linkage of the rig.
pub const LINKAGE: LinkageTable = LinkageTable {
    first_angle: MilliDegree(44_000),
    angle_step: MilliDegree(2_000),
    travel: travel_points(),
};

const fn table<const N: usize>(curve: &[(i32, i32); N]) -> ValveTable {
    let empty = ValvePoint {
        flow: MicroLitrePerSecond(0),
        current: MilliAmp(0),
    };
    let mut points = [empty; VALVE_POINTS];
    let mut at = 0;
    while at < N {
        // 1 l/min is 1 000 000 ul in 60 s; rounded to nearest.
        let flow = (curve[at].1 * 1000 + 30) / 60;
        points[at] = ValvePoint {
            flow: MicroLitrePerSecond(flow),
            current: MilliAmp(curve[at].0),
        };
        at += 1;
    }
    ValveTable {
        count: N as u32,
        points,
    }
}

const fn travel_points() -> [Micrometre; LINKAGE_POINTS] {
    let mut points = [Micrometre(0); LINKAGE_POINTS];
    let mut at = 0;
    while at < LINKAGE_POINTS {
        points[at] = Micrometre(TRAVEL[at]);
        at += 1;
    }
    points
}
