//! Measurement: lists, events, time stamps, and overload.

use hitch_protocols::xcp::Event;
use hitch_protocols::xcp::map::MEASUREMENT_BASE;
use hitch_protocols::xcp::measurements::{COUNT, EcuState, INFO, Width};
use hitch_quantities::units::{MilliAmp, MilliDegree};
use hitch_quantities::{Inputs, Outputs, State};

use crate::client::{ACCESS_DENIED, Desk, OUT_OF_RANGE, scalar};

const WITH_TIME: u8 = 0x10;

/// Address of a measurement.
fn measurement(name: &str) -> u32 {
    let index = INFO.iter().position(|info| info.name == name).unwrap();
    MEASUREMENT_BASE + 4 * u32::try_from(index).unwrap()
}

fn bytes(width: Width) -> u8 {
    match width {
        Width::U8 => 1,
        Width::U16 | Width::I16 => 2,
        Width::U32 | Width::I32 => 4,
    }
}

/// Sets up one list; each table is a list of addresses and sizes.
fn set_up(desk: &mut Desk, mode: u8, event: Event, prescaler: u8, tables: &[&[(u32, u8)]]) {
    desk.obeyed(&[0xD6]);
    desk.obeyed(&[0xD5, 0, 1, 0]);
    desk.obeyed(&[0xD4, 0, 0, 0, u8::try_from(tables.len()).unwrap()]);
    for (number, table) in (0..).zip(tables) {
        desk.obeyed(&[0xD3, 0, 0, 0, number, u8::try_from(table.len()).unwrap()]);
    }
    for (number, table) in (0..).zip(tables) {
        desk.obeyed(&[0xE2, 0, 0, 0, number, 0]);
        for (address, size) in *table {
            let [a, b, c, d] = address.to_le_bytes();
            desk.obeyed(&[0xE1, 0xFF, *size, 0, a, b, c, d]);
        }
    }
    desk.obeyed(&[0xE0, mode, 0, 0, event as u8, 0, prescaler, 0]);
}

fn sample(desk: &mut Desk, angle: i32) {
    let inputs = Inputs {
        rocker_angle: Some(MilliDegree(angle)),
        ..Inputs::default()
    };
    let outputs = Outputs {
        state: State::Lifting,
        lift_current: MilliAmp(1_500),
        ..Outputs::default()
    };
    desk.measurements
        .sample(&inputs, &outputs, &EcuState::default());
}

#[test]
fn a_list_is_sampled_with_its_event_and_time() {
    let mut desk = Desk::connected();
    let angle = (measurement("rocker_angle"), 4);
    let state = (measurement("state"), 1);
    let current = (measurement("lift_current"), 2);
    set_up(
        &mut desk,
        WITH_TIME,
        Event::Every10Ms,
        1,
        &[&[state, current], &[angle]],
    );
    assert_eq!(
        desk.obeyed(&[0xDE, 2, 0, 0]),
        [0],
        "first packet of the list"
    );
    desk.event(Event::Every10Ms);
    assert!(desk.packets().is_empty(), "selected, not started");
    desk.obeyed(&[0xDD, 1]);
    assert_eq!(desk.obeyed(&[0xFD])[0], 0x40, "measuring");
    sample(&mut desk, 90_123);
    desk.now_us = 0x0102_0304;
    desk.event(Event::Every1Ms);
    assert!(desk.packets().is_empty(), "another event");
    desk.event(Event::Every10Ms);
    let [low, high] = 1_500_u16.to_le_bytes();
    let angle = 90_123_i32.to_le_bytes();
    assert_eq!(
        desk.packets(),
        [
            vec![0, 4, 3, 2, 1, 2, low, high],
            [&[1], &angle[..]].concat()
        ]
    );
    desk.obeyed(&[0xDD, 0]);
    desk.event(Event::Every10Ms);
    assert!(desk.packets().is_empty(), "stopped");
}

#[test]
fn a_prescaler_takes_every_nth() {
    let mut desk = Desk::connected();
    set_up(
        &mut desk,
        0,
        Event::Every1Ms,
        5,
        &[&[(measurement("state"), 1)]],
    );
    desk.obeyed(&[0xDE, 1, 0, 0]);
    let mut taken = Vec::new();
    for step in 0..20 {
        desk.event(Event::Every1Ms);
        if !desk.packets().is_empty() {
            taken.push(step);
        }
    }
    assert_eq!(taken, [0, 5, 10, 15]);
}

#[test]
fn lists_have_packets_of_their_own() {
    let mut desk = Desk::connected();
    desk.obeyed(&[0xD6]);
    desk.obeyed(&[0xD5, 0, 2, 0]);
    desk.obeyed(&[0xD4, 0, 0, 0, 2]);
    desk.obeyed(&[0xD4, 0, 1, 0, 1]);
    for (list, table) in [(0, 0), (0, 1), (1, 0)] {
        desk.obeyed(&[0xD3, 0, list, 0, table, 1]);
    }
    let [a, b, c, d] = measurement("state").to_le_bytes();
    for (list, table) in [(0, 0), (0, 1), (1, 0)] {
        desk.obeyed(&[0xE2, 0, list, 0, table, 0]);
        desk.obeyed(&[0xE1, 0xFF, 1, 0, a, b, c, d]);
    }
    desk.obeyed(&[0xE0, 0, 1, 0, 0, 0, 1, 0]);
    assert_eq!(desk.obeyed(&[0xDE, 1, 0, 0]), [0]);
    assert_eq!(
        desk.obeyed(&[0xDE, 1, 1, 0]),
        [2],
        "behind those of the first"
    );
    assert_eq!(desk.obeyed(&[0xDF, 0, 1, 0]), [0x40, 0, 0, 0, 0, 1, 0]);
    desk.event(Event::Every1Ms);
    assert_eq!(desk.packets(), [[2, 0]]);
}

#[test]
fn a_bus_that_is_too_slow_costs_whole_samples_and_the_tool_is_told_once() {
    let mut desk = Desk::connected();
    let angle = (measurement("rocker_angle"), 4);
    set_up(
        &mut desk,
        0,
        Event::Every1Ms,
        1,
        &[&[angle], &[angle], &[angle]],
    );
    desk.obeyed(&[0xDE, 1, 0, 0]);
    for step in 0..40 {
        sample(&mut desk, step);
        desk.event(Event::Every1Ms);
    }
    let packets = desk.packets();
    let (events, samples): (Vec<_>, Vec<_>) =
        packets.into_iter().partition(|packet| packet[0] == 0xFD);
    assert_eq!(events, [[0xFD, 0x06]]);
    assert_eq!(samples.len(), 30, "ten whole samples fit into the queue");
    for (step, sample) in samples.chunks(3).enumerate() {
        for (number, packet) in sample.iter().enumerate() {
            assert_eq!(usize::from(packet[0]), number);
            assert_eq!(usize::from(packet[1]), step, "all of one moment");
        }
    }
    // When the queue is empty sampling continues, and the next overload is reported again.
    for _ in 0..20 {
        desk.event(Event::Every1Ms);
    }
    let told = desk
        .packets()
        .iter()
        .filter(|packet| packet[0] == 0xFD)
        .count();
    assert_eq!(told, 1);
}

#[test]
fn lists_that_make_no_sense_are_refused() {
    let mut desk = Desk::connected();
    let angle = (measurement("rocker_angle"), 4);
    set_up(&mut desk, WITH_TIME, Event::Every1Ms, 1, &[&[angle]]);
    assert_eq!(
        desk.ask(&[0xDE, 1, 0, 0]),
        Err(0x2A),
        "no room beside the time"
    );
    set_up(&mut desk, 0, Event::Every1Ms, 1, &[&[angle, angle]]);
    assert_eq!(desk.ask(&[0xDE, 1, 0, 0]), Err(0x2A), "no room for two");
    desk.obeyed(&[0xD6]);
    assert_eq!(
        desk.ask(&[0xDE, 1, 0, 0]),
        Err(OUT_OF_RANGE),
        "no such list"
    );
    desk.obeyed(&[0xD5, 0, 1, 0]);
    assert_eq!(desk.ask(&[0xDE, 1, 0, 0]), Err(0x2A), "nothing in it");
    desk.obeyed(&[0xD4, 0, 0, 0, 1]);
    desk.obeyed(&[0xD3, 0, 0, 0, 0, 1]);
    assert_eq!(
        desk.ask(&[0xDE, 1, 0, 0]),
        Err(0x2A),
        "an entry that wasn't written"
    );
    desk.obeyed(&[0xE2, 0, 0, 0, 0, 0]);
    assert_eq!(
        desk.ask(&[0xE1, 0xFF, 4, 0, 0, 0, 0, 0]),
        Err(ACCESS_DENIED),
        "nothing there"
    );
    let [a, b, c, d] = angle.0.to_le_bytes();
    assert_eq!(
        desk.ask(&[0xE1, 3, 4, 0, a, b, c, d]),
        Err(OUT_OF_RANGE),
        "single bits"
    );
    assert_eq!(
        desk.ask(&[0xE1, 0xFF, 8, 0, a, b, c, d]),
        Err(OUT_OF_RANGE),
        "too large"
    );
    assert_eq!(
        desk.ask(&[0xE0, 0x20, 0, 0, 0, 0, 1, 0]),
        Err(0x27),
        "packets without a number"
    );
    assert_eq!(
        desk.ask(&[0xE0, 0, 0, 0, 3, 0, 1, 0]),
        Err(OUT_OF_RANGE),
        "no such event"
    );
    assert_eq!(
        desk.ask(&[0xE2, 0, 0, 0, 0, 1]),
        Err(OUT_OF_RANGE),
        "no such entry"
    );
}

#[test]
fn what_is_running_stays_as_it_is() {
    let mut desk = Desk::connected();
    let state = (measurement("state"), 1);
    set_up(&mut desk, 0, Event::Every1Ms, 1, &[&[state]]);
    desk.obeyed(&[0xDE, 1, 0, 0]);
    desk.obeyed(&[0xE2, 0, 0, 0, 0, 0]);
    let [a, b, c, d] = state.0.to_le_bytes();
    assert_eq!(desk.ask(&[0xE1, 0xFF, 1, 0, a, b, c, d]), Err(0x11));
    assert_eq!(desk.ask(&[0xE0, 0, 0, 0, 1, 0, 1, 0]), Err(0x11));
    assert_eq!(desk.ask(&[0xD5, 0, 1, 0]), Err(0x11));
    // A tool that reconnects starts without lists.
    desk.obeyed(&[0xFF, 0]);
    desk.event(Event::Every1Ms);
    assert!(desk.packets().is_empty());
}

#[test]
fn room_is_bounded_and_handed_out_in_order() {
    let mut desk = Desk::connected();
    desk.obeyed(&[0xD6]);
    assert_eq!(desk.ask(&[0xD5, 0, 5, 0]), Err(0x30));
    desk.obeyed(&[0xD5, 0, 2, 0]);
    assert_eq!(desk.ask(&[0xD4, 0, 0, 0, 18]), Err(0x30));
    desk.obeyed(&[0xD4, 0, 1, 0, 1]);
    assert_eq!(
        desk.ask(&[0xD4, 0, 0, 0, 1]),
        Err(0x29),
        "lists in their order"
    );
    assert_eq!(desk.ask(&[0xD3, 0, 1, 0, 0, 65]), Err(0x30));
    desk.obeyed(&[0xD3, 0, 1, 0, 0, 64]);
    assert_eq!(desk.ask(&[0xD3, 0, 1, 0, 0, 1]), Err(0x29), "once");
    assert_eq!(
        desk.ask(&[0xD4, 0, 0, 0, 1]),
        Err(0x29),
        "tables before entries"
    );
    assert_eq!(desk.ask(&[0xD5, 0, 2, 0]), Err(0x29), "lists before tables");
}

#[test]
fn clock_and_events_are_described() {
    let mut desk = Desk::connected();
    desk.now_us = 0x0A0B_0C0D;
    assert_eq!(desk.obeyed(&[0xDC]), [0, 0, 0, 0x0D, 0x0C, 0x0B, 0x0A]);
    assert_eq!(desk.obeyed(&[0xDA]), [0x93, 0, 0, 3, 0, 0, 0]);
    desk.obeyed(&[0xD5, 0, 3, 0]);
    assert_eq!(desk.obeyed(&[0xDA])[1], 3, "lists");
    assert_eq!(desk.obeyed(&[0xD9]), [1, 7, 1, 0, 0x34, 1, 0]);
    for (number, name) in (0..).zip(["1 ms", "10 ms", "100 ms"]) {
        let info = desk.obeyed(&[0xD7, 0, number, 0]);
        let period: u8 = name.split(' ').next().unwrap().parse().unwrap();
        assert_eq!(info[3..5], [period, 6], "in milliseconds");
        assert_eq!(desk.obeyed(&[0xF5, info[2]]), name.as_bytes());
    }
    assert_eq!(desk.ask(&[0xD7, 0, 3, 0]), Err(OUT_OF_RANGE));
}

/// The root is computed on the ECU in single precision, from an integer.
#[test]
fn the_noise_of_the_angle_is_read_in_degrees() {
    let mut desk = Desk::connected();
    let noise_deg = |desk: &mut Desk, angle_squares| {
        let state = EcuState {
            angle_squares,
            ..EcuState::default()
        };
        desk.measurements
            .sample(&Inputs::default(), &Outputs::default(), &state);
        f32::from_bits(
            desk.read(measurement("angle_noise"))
                .unwrap()
                .cast_unsigned(),
        )
    };
    assert_eq!(noise_deg(&mut desk, 0), 0.0);
    // 0.1 degree, one sigma: a mean square of the second difference of 6 * 10 000 mdeg2.
    let found_deg = noise_deg(&mut desk, 1_024 * 60_000);
    assert!((found_deg - 0.1).abs() < 0.000_2, "{found_deg}");
}

#[test]
fn parameters_can_be_measured_too() {
    let mut desk = Desk::connected();
    let gain = scalar("position", "approach_gain");
    set_up(&mut desk, 0, Event::Every1Ms, 1, &[&[(gain, 4)]]);
    let value = desk.read(gain).unwrap();
    desk.obeyed(&[0xDE, 1, 0, 0]);
    desk.event(Event::Every1Ms);
    assert_eq!(desk.packets(), [[&[0], &value.to_le_bytes()[..]].concat()]);
}

#[test]
fn all_measurements_fit_into_one_list_and_into_their_width() {
    let mut desk = Desk::connected();
    assert_eq!(INFO.len(), COUNT);
    for info in INFO {
        let bits = 8 * u32::from(bytes(info.width));
        let signed = matches!(info.width, Width::I16 | Width::I32);
        let (low, high) = if signed {
            (-(1_i64 << (bits - 1)), (1 << (bits - 1)) - 1)
        } else {
            (0, (1 << bits) - 1)
        };
        assert!(
            i64::from(info.min) >= low && i64::from(info.max) <= high,
            "{}",
            info.name
        );
        assert!(desk.read(measurement(info.name)).is_ok());
    }
    assert!(
        INFO.iter()
            .all(|info| !info.is_float || bytes(info.width) == 4),
        "a number in single precision has 32 bits"
    );
    let total: usize = INFO.iter().map(|info| usize::from(bytes(info.width))).sum();
    assert!(total <= 17 * 7, "{total} bytes");
}
