//! The inverse valve map against an independent solution in f64, over its whole input grid.

use hitch_control::valve::inverse_curve::{FlowSteps, InverseCurve};
use hitch_control::valve::valve_map::{ValveCurves, ValveMap};
use hitch_quantities::Calibration;
use hitch_quantities::units::{MicroLitrePerSecond, MilliAmp, MilliBar};

/// Current error that the map may have, mA.
const ALLOWED_MA: f64 = 1.0;
/// Microlitres a second in one litre a minute.
const UL_S_PER_LPM: f64 = 1e6 / 60.0;
/// Where the tables saturate, l/min.
const LIFT_SATURATION_LPM: f64 = 39.929;
const LOWER_SATURATION_LPM: f64 = 58.717;

/// The manufacturer's tables as printed: current in A, flow in l/min.
const LIFT: &str = include_str!("../../../model/paper/data/table2a_lift_valve.csv");
const LOWER: &str = include_str!("../../../model/paper/data/table2b_lower_valve.csv");

fn table(csv: &str) -> Vec<(f64, f64)> {
    let rows = csv
        .lines()
        .filter(|line| line.starts_with(|c: char| c.is_ascii_digit()));
    rows.map(|line| {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        (cells[0], cells[2])
    })
    .collect()
}

/// Smallest current, in mA, at which the curve reaches `flow_lpm`, by bisection on the forward curve.
fn reference_ma(curve: &[(f64, f64)], flow_lpm: f64) -> f64 {
    let forward = |current_a: f64| {
        let above = curve
            .iter()
            .position(|&(a, _)| a >= current_a)
            .unwrap_or(curve.len() - 1)
            .max(1);
        let ((a0, q0), (a1, q1)) = (curve[above - 1], curve[above]);
        q0 + (q1 - q0) * (current_a - a0) / (a1 - a0)
    };
    let (mut low_a, mut high_a) = (0.0, 3.5);
    for _ in 0..60 {
        let middle_a = 0.5 * (low_a + high_a);
        if forward(middle_a) < flow_lpm {
            low_a = middle_a;
        } else {
            high_a = middle_a;
        }
    }
    1e3 * high_a
}

/// The reference at each whole microlitre a second of the reference drop, so that the grid costs no bisections.
struct Reference {
    curve: Vec<(f64, f64)>,
    saturation_lpm: f64,
}

impl Reference {
    fn ma(&self, flow_lpm: f64) -> f64 {
        reference_ma(&self.curve, flow_lpm.min(self.saturation_lpm))
    }
}

fn curves() -> ValveCurves {
    ValveCurves::of(&Calibration::nominal())
}

fn map(curves: &ValveCurves, drop: MilliBar) -> ValveMap<'_> {
    curves.at(curves.scale(drop))
}

// REQ-MOTION-03
#[test]
fn lift_current_is_right_at_every_flow() {
    let curves = curves();
    let map = map(&curves, MilliBar(15_000));
    let reference = Reference {
        curve: table(LIFT),
        saturation_lpm: LIFT_SATURATION_LPM,
    };
    let (mut worst_ma, mut last) = (0.0f64, MilliAmp(0));
    for flow in 0..=800_000 {
        let current = map.lift_current(MicroLitrePerSecond(flow));
        assert!(
            current >= last && current <= MilliAmp(3_500),
            "{flow} ul/s gives {current:?} after {last:?}"
        );
        last = current;
        if flow == 0 {
            assert_eq!(current, MilliAmp(0), "no flow is no current");
        } else if flow % 7 == 0 || flow < 3_000 {
            let error_ma = f64::from(current.0) - reference.ma(f64::from(flow) / UL_S_PER_LPM);
            worst_ma = worst_ma.max(error_ma.abs());
        }
    }
    println!("lift map: worst current error {worst_ma:.3} mA");
    assert!(worst_ma <= ALLOWED_MA, "{worst_ma} mA");
}

// REQ-MOTION-03
#[test]
fn lowering_current_is_right_at_every_flow_and_drop() {
    let curves = curves();
    let reference = Reference {
        curve: table(LOWER),
        saturation_lpm: LOWER_SATURATION_LPM,
    };
    let mut worst_ma = 0.0f64;
    for drop in (200..1_000)
        .step_by(100)
        .chain((1_000..30_000).step_by(250))
        .chain((30_000..=350_000).step_by(2_500))
    {
        let map = map(&curves, MilliBar(drop));
        let scale = (15_000.0 / f64::from(drop)).sqrt();
        let mut last = MilliAmp(0);
        // To well past saturation at this drop, in steps that hit every table piece.
        let end = (1.1 * LOWER_SATURATION_LPM * UL_S_PER_LPM / scale) as i32;
        for flow in (1..200).chain((200..=end).step_by((end / 4_000).max(1) as usize)) {
            let current = map.lower_current(MicroLitrePerSecond(flow));
            assert!(
                current >= last && current <= MilliAmp(3_500),
                "{flow} ul/s at {drop} mbar"
            );
            last = current;
            let error_ma =
                f64::from(current.0) - reference.ma(f64::from(flow) / UL_S_PER_LPM * scale);
            worst_ma = worst_ma.max(error_ma.abs());
        }
        assert_eq!(map.lower_current(MicroLitrePerSecond(0)), MilliAmp(0));
    }
    println!("lowering map: worst current error {worst_ma:.3} mA");
    assert!(worst_ma <= ALLOWED_MA, "{worst_ma} mA");
}

#[test]
fn less_drop_never_asks_for_less_current() {
    let curves = curves();
    for flow in (1..1_500_000).step_by(2_999) {
        let mut last = MilliAmp(i32::MAX);
        for drop in (100..350_000).step_by(500) {
            let current = map(&curves, MilliBar(drop)).lower_current(MicroLitrePerSecond(flow));
            assert!(current <= last, "{flow} ul/s at {drop} mbar");
            last = current;
        }
    }
}

#[test]
fn axis_ends_are_held() {
    let curves = curves();
    for drop in [i32::MIN, -1, 0, 1, i32::MAX] {
        let map = map(&curves, MilliBar(drop));
        for flow in [i32::MIN, -1, 0] {
            assert_eq!(map.lift_current(MicroLitrePerSecond(flow)), MilliAmp(0));
            assert_eq!(map.lower_current(MicroLitrePerSecond(flow)), MilliAmp(0));
        }
        assert_eq!(
            map.lift_current(MicroLitrePerSecond(i32::MAX)),
            MilliAmp(3_252)
        );
        assert_eq!(
            map.lower_current(MicroLitrePerSecond(i32::MAX)),
            MilliAmp(3_119)
        );
    }
    let map = map(&curves, MilliBar(15_000));
    assert_eq!(
        map.lift_current(MicroLitrePerSecond(1)),
        MilliAmp(1_127),
        "just above the threshold of 1.126 A"
    );
    assert_eq!(
        map.lower_current(MicroLitrePerSecond(1)),
        MilliAmp(1_000),
        "just above the threshold of 0.999 A"
    );
}

// REQ-MOTION-03
#[test]
fn the_map_and_its_inverse_meet() {
    let calibration = Calibration::nominal();
    for (table, name) in [(&calibration.lift, "lift"), (&calibration.lower, "lower")] {
        let mut inverse = InverseCurve::EMPTY;
        inverse.fill(table, FlowSteps::MICROLITRES);
        for milliampere in 0..=3_500 {
            let current = MilliAmp(milliampere);
            let flow = table.flow(current);
            assert_eq!(
                flow.0 == 0,
                current <= table.threshold(),
                "{name} at {current:?}: no flow exactly up to the threshold"
            );
            if flow.0 > 0 && flow < table.saturation() {
                let back = inverse.current(flow.0);
                assert!(
                    (back - current).magnitude() <= MilliAmp(1),
                    "{name}: {current:?} comes back as {back:?}"
                );
            }
        }
    }
}
