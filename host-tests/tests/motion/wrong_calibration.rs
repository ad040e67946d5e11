//! Untaught machines with a wrong calibration, against the plain reference design of [`truth_rigs::drawn_hitches::plain`].

use hitch_quantities::calibration::valve_table::ValveTable;
use hitch_quantities::units::{MicroLitrePerSecond, MilliAmp, SquareMillimetre};
use hitch_quantities::{Calibration, ValidCalibration};
use host_tests::seeds::{cases, seeds};
use rand::{Rng, SeedableRng};
use rand_pcg::Pcg64;
use rayon::prelude::*;
use truth_rigs::drawn_hitches::draw::{Drawn, draw};
use truth_rigs::drawn_hitches::session::{MoveFigures, drive};
use truth_rigs::drawn_hitches::{figures, plain};

/// Machines by day, and with `HITCH_THOROUGH`.
const FEW_MACHINES: u64 = 12;
const MACHINES: u64 = 600;
/// First seed.
const SEED: u64 = 90_001;
/// Moves of each.
const MOVES: usize = 6;

/// Lags that the calibration does not have.
#[derive(Clone, Copy)]
enum Lag {
    /// Those of the drawn machines: spools of 20 to 45 ms, sensors of up to 10 ms.
    Usual,
    /// A spool of up to 150 ms.
    Spool,
    /// An angle sensor of up to 100 ms.
    Sensor,
}

/// The nominal calibration with every value off by its tolerance: flow 10 %, hysteresis 50 %, bore 0.5 %, drop 20 %. The
/// drawn machines differ by 0.1 A in their thresholds.
fn wrong_calibration(random: &mut Pcg64) -> ValidCalibration {
    let mut off = |tolerance: f64| {
        if random.random::<bool>() {
            1.0 + tolerance
        } else {
            1.0 - tolerance
        }
    };
    let mut calibration = Calibration::nominal();
    for table in [&mut calibration.lift, &mut calibration.lower] {
        scale_flow(table, off(0.1));
    }
    let hydraulics = &mut calibration.hydraulics;
    let scaled = |value: i32, factor: f64| (f64::from(value) * factor).round() as i32;
    hydraulics.hysteresis = MilliAmp(scaled(hydraulics.hysteresis.0, off(0.5)));
    hydraulics.piston_area = SquareMillimetre(scaled(hydraulics.piston_area.0, off(0.01)));
    hydraulics.assumed_drop.0 = scaled(hydraulics.assumed_drop.0, off(0.2));
    calibration.sealed().validate().unwrap()
}

fn scale_flow(table: &mut ValveTable, factor: f64) {
    for point in &mut table.points {
        point.flow = MicroLitrePerSecond((f64::from(point.flow.0) * factor).round() as i32);
    }
}

/// The moves of a machine with the controller and with the reference design.
fn both(seed: u64, lag: Lag) -> [Vec<MoveFigures>; 2] {
    let mut machine: Drawn = draw(seed, MOVES);
    let mut random = Pcg64::seed_from_u64(seed ^ 0x3A_11ED);
    let calibration = wrong_calibration(&mut random);
    match lag {
        Lag::Usual => (),
        Lag::Spool => machine.conditions.spool_lag_s = random.random_range(0.045..0.15),
        Lag::Sensor => machine.physics.sensors.angle_lag_s = random.random_range(0.01..0.1),
    }
    [drive(&machine, &calibration), plain::drive(&machine)]
}

/// Machines on which the controller is worse than the reference design.
#[derive(Debug, Default)]
struct Worse {
    machines: usize,
    /// Median of the move's time more than 10 % longer.
    slower: usize,
    /// Largest overshoot beyond the bar of 0.3 degree, and larger.
    overshooting: usize,
    /// With a fault.
    locked: usize,
    /// Coils that are switched on more than twice after an arrival.
    hunting: usize,
    /// The same of the reference design.
    plain_hunting: usize,
}

fn compare(lag: Lag) -> Worse {
    let pairs: Vec<_> = (SEED..SEED + cases(seeds(FEW_MACHINES), MACHINES))
        .into_par_iter()
        .map(|seed| both(seed, lag))
        .collect();
    let mut worse = Worse::default();
    for (seed, pair) in (SEED..).zip(&pairs) {
        let spread = |of| {
            pair.each_ref().map(|moves: &Vec<MoveFigures>| {
                figures::spread(&moves.iter().collect::<Vec<_>>(), of)
            })
        };
        let hunts = |moves: &[MoveFigures]| moves.iter().any(|moved| moved.switched_on_after > 2);
        let [time, plain_time] = spread(|moved| moved.ratio).map(|[median, _, _]| median);
        let [over, plain_over] = spread(|moved| moved.overshoot_deg).map(|[_, _, most]| most);
        worse.machines += 1;
        worse.slower += usize::from(time > 1.1 * plain_time);
        worse.overshooting += usize::from(over > plain_over.max(0.3));
        if let Some(fault) = pair[0].iter().find_map(|moved| moved.fault) {
            println!("seed {seed} locks itself: {fault:?}");
            worse.locked += 1;
        }
        worse.hunting += usize::from(hunts(&pair[0]));
        worse.plain_hunting += usize::from(hunts(&pair[1]));
    }
    for (name, at) in [("controller", 0), ("reference", 1)] {
        let moves: Vec<&MoveFigures> = pairs.iter().flat_map(|pair| &pair[at]).collect();
        println!("{}", figures::table(name, &moves));
    }
    println!("seeds from {SEED}: {worse:?}");
    worse
}

/// Largest shares of the machines.
struct Bounds {
    slower: f64,
    overshooting: f64,
    locked: f64,
    hunting: f64,
}

fn assert_within(worse: &Worse, bounds: &Bounds) {
    for (name, count, bound) in [
        ("slower", worse.slower, bounds.slower),
        ("overshooting", worse.overshooting, bounds.overshooting),
        ("locked", worse.locked, bounds.locked),
        ("hunting", worse.hunting, bounds.hunting),
    ] {
        let share = count as f64 / worse.machines as f64;
        assert!(share <= bound, "{name}: {share}, the bound is {bound}");
    }
}

#[test]
fn values_off_by_their_tolerance_neither_lock_a_machine_nor_make_it_hunt() {
    let bounds = Bounds {
        slower: 0.25,
        overshooting: 0.15,
        locked: 0.0,
        hunting: 0.0,
    };
    assert_within(&compare(Lag::Usual), &bounds);
}

/// Some of these machines lock themselves; docs/firmware.md has the share.
#[test]
fn an_unknown_slow_spool_overshoots_less_than_with_the_reference_design() {
    let bounds = Bounds {
        slower: 0.2,
        overshooting: 0.15,
        locked: 0.25,
        hunting: 0.1,
    };
    assert_within(&compare(Lag::Spool), &bounds);
}

#[test]
fn an_unknown_sensor_lag_overshoots_less_than_with_the_reference_design() {
    let bounds = Bounds {
        slower: 0.2,
        overshooting: 0.15,
        locked: 0.15,
        hunting: 0.15,
    };
    assert_within(&compare(Lag::Sensor), &bounds);
}
