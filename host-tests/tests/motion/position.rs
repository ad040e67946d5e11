//! Motion compared with the limits of the plant, with typical hysteresis, friction, spool lag and air, cold oil, and
//! threshold offsets of 0.1 A, after teaching.

use hitch_results::closed_loop::{MoveResult, Scenario, Summary, run};
use host_tests::seeds::cases;
use host_tests::teaching::{taught_calibration, typical};

const SHIFTS_A: [(f64, f64); 4] = [(0.1, -0.1), (-0.1, 0.1), (0.1, 0.1), (-0.1, -0.1)];

/// Moves with each of them.
const MOVES: usize = 125;

fn print_worst(results: &[MoveResult], what: &str, of: impl Fn(&MoveResult) -> f64) {
    let mut sorted: Vec<&MoveResult> = results.iter().collect();
    sorted.sort_by(|a, b| of(b).total_cmp(&of(a)));
    println!("worst {what}:");
    for result in sorted.iter().take(6) {
        println!(
            "  {:5.1} to {:5.1} deg, {:3.0} kg, {:2.0} C: {:.2}, overshoot {:.2} deg, off {:.2} deg, swing {:.2}, on {}",
            result.from_deg,
            result.to_deg,
            result.load_kg,
            result.oil_temperature_c,
            result.ratio,
            result.overshoot_deg,
            result.final_error_deg,
            result.pressure_swing_ratio,
            result.switched_on_after
        );
    }
}

// REQ-MOTION-01
#[test]
fn motion_is_close_to_what_the_plant_allows() {
    let mut all = Vec::new();
    let shifts_a = cases(&SHIFTS_A[..1], &SHIFTS_A);
    for &(lift_a, lower_a) in shifts_a {
        let model = typical(lift_a, lower_a);
        let calibration = taught_calibration(&model, 150.0).unwrap();
        let driven = run(&model, &calibration, &Scenario::Limits.moves(&model, None)).unwrap();
        println!("{lift_a:5.2} {lower_a:5.2} A: {:?}", driven.summary);
        all.extend(driven.results);
    }
    print_worst(&all, "time ratio", |result| result.ratio);
    print_worst(&all, "overshoot", |result| result.overshoot_deg);
    print_worst(&all, "final error", |result| result.final_error_deg);
    print_worst(&all, "pressure swing", |result| result.pressure_swing_ratio);
    print_worst(&all, "activity", |result| {
        f64::from(result.switched_on_after)
    });
    let summary = Summary::of(&all).unwrap();
    println!("{} moves: {summary:?}", all.len());
    assert!(all.len() >= MOVES * shifts_a.len(), "{} moves", all.len());
    assert!(summary.ratio_median <= 1.15, "{summary:?}");
    assert!(summary.ratio_p95 <= 1.4, "{summary:?}");
    assert!(summary.overshoot_max_deg <= 0.3, "{summary:?}");
    assert!(summary.final_error_max_deg <= 0.3, "{summary:?}");
    assert!(summary.pressure_swing_ratio_max <= 1.5, "{summary:?}");
    assert_eq!(summary.switched_on_after, 0, "{summary:?}");
}
