//! Sensors.

use hitch_field::noise::Noise;
use hitch_field::sensors::draft_pins::{DraftPins, DraftPinsConstants, PinFault};
use hitch_field::sensors::lagged::{Lagged, LaggedConstants};

use crate::assert_near;

fn quiet() -> DraftPinsConstants {
    let mut constants = DraftPinsConstants::two_of_40_kn();
    constants.left.noise = 0.0;
    constants.right.noise = 0.0;
    constants
}

fn read(constants: DraftPinsConstants, draft_n: f64) -> [f64; 2] {
    let readings = DraftPins::new(constants, Noise::new(1, 0)).read(draft_n);
    [readings.left, readings.right]
}

#[test]
fn pins_read_half_of_the_supply_at_zero_and_a_quarter_more_at_nominal_force() {
    assert_eq!(read(quiet(), 0.0), [0.5, 0.5]);
    assert_eq!(read(quiet(), 80e3), [0.75, 0.75]);
    assert_eq!(read(quiet(), -80e3), [0.25, 0.25]);
    assert_eq!(read(quiet(), 1e9), [1.0, 1.0]);
}

#[test]
fn shares_offsets_and_gains_act_on_each_pin() {
    let mut constants = quiet();
    constants.left_share = 0.75;
    constants.lower_link_share = 0.8;
    constants.left.gain_error = 0.1;
    constants.right.zero_offset = -0.02;
    let [left, right] = read(constants, 40e3);
    assert_near(left, 0.5 + 1.1 * 0.25 * 24.0 / 40.0, 1e-12);
    assert_near(right, 0.5 + 0.25 * 8.0 / 40.0 - 0.02, 1e-12);
}

#[test]
fn a_fault_of_one_pin_leaves_the_other() {
    let sound = read(DraftPinsConstants::two_of_40_kn(), 20e3);
    for (fault, output) in [(PinFault::Broken, 0.0), (PinFault::ShortToSupply, 1.0)] {
        let mut constants = DraftPinsConstants::two_of_40_kn();
        constants.left.fault = fault;
        assert_eq!(read(constants, 20e3), [output, sound[1]]);
    }
}

#[test]
fn a_lagged_sensor_is_at_63_percent_after_its_time_constant() {
    let constants = LaggedConstants {
        noise: 0.0,
        gain_error: 0.05,
        offset: 0.2,
        ..LaggedConstants::radar()
    };
    for steps in [1, 30] {
        let mut sensor = Lagged::new(constants.clone(), 0.0, Noise::new(1, 0));
        let reading = (0..steps).fold(0.0, |_, _| {
            sensor.read(2.0, constants.lag_s / f64::from(steps))
        });
        let followed = 2.0 * (1.0 - (-1.0_f64).exp());
        assert_near(reading, 1.05 * followed + 0.2, 1e-12);
    }
}

#[test]
fn noise_has_its_deviation() {
    let constants = LaggedConstants::depth();
    let mut sensor = Lagged::new(constants.clone(), 0.2, Noise::new(5, 0));
    let count = 100_000;
    let squares: f64 = (0..count)
        .map(|_| (sensor.read(0.2, 0.01) - 0.2).powi(2))
        .sum();
    assert_near(
        (squares / f64::from(count)).sqrt() / constants.noise,
        1.0,
        0.02,
    );
}
