//! Each electrical fault of the safety table, with its reaction time at the pin.

use anyhow::{Context, Result, ensure};
use hitch_ecu::{AdcCode, Contacts};
use hitch_workbench::ecu::Order;

use super::rig::Rig;
use super::setup::Setup;
use crate::ENABLE_READ_BACK;

/// A fault of wires, sensors and coils.
#[derive(Clone, Copy)]
pub struct Fault {
    /// Description.
    pub name: &'static str,
    /// Longest reaction at the pin, ms: the row's time, a millisecond until it is sampled, and one to react.
    pub most_ms: f64,
    /// Whether it shows in any state: a coil's faults only show while it is driven, a jump is over once it has
    /// happened.
    pub always_shows: bool,
    /// Whether only a restart clears it.
    pub until_restart: bool,
    /// Its effect on the samples, in the step of this number.
    pub inject: fn(&mut Contacts, usize),
}

const fn code(code: u16) -> AdcCode {
    AdcCode::new(code)
}

/// Ends of the converters' range: a short to ground, and one to the supply.
const LOW: AdcCode = code(0);
const HIGH: AdcCode = code(4095);

/// The faults.
pub const FAULTS: [Fault; 17] = [
    Fault {
        name: "supply below 8 V",
        most_ms: 12.0,
        always_shows: true,
        until_restart: false,
        inject: |contacts, _| contacts.samples.supply = code(7_400 / 6),
    },
    Fault {
        name: "supply above 16.8 V",
        most_ms: 12.0,
        always_shows: true,
        until_restart: false,
        inject: |contacts, _| contacts.samples.supply = code(18_000 / 6),
    },
    Fault {
        name: "supply alternates each millisecond",
        most_ms: 12.0,
        always_shows: true,
        until_restart: false,
        inject: |contacts, step| {
            if step % 2 == 0 {
                contacts.samples.supply = code(7_000 / 6);
            }
        },
    },
    Fault {
        name: "lever shorted to ground",
        most_ms: 7.0,
        always_shows: true,
        until_restart: false,
        inject: |contacts, _| contacts.samples.lever = LOW,
    },
    Fault {
        name: "lever shorted to its supply",
        most_ms: 7.0,
        always_shows: true,
        until_restart: false,
        inject: |contacts, _| contacts.samples.lever = HIGH,
    },
    Fault {
        name: "angle shorted to ground",
        most_ms: 7.0,
        always_shows: true,
        until_restart: false,
        inject: |contacts, _| contacts.samples.rocker_angle = LOW,
    },
    Fault {
        name: "angle shorted to its supply",
        most_ms: 7.0,
        always_shows: true,
        until_restart: false,
        inject: |contacts, _| contacts.samples.rocker_angle = HIGH,
    },
    Fault {
        name: "second angle track shorted to ground",
        most_ms: 7.0,
        always_shows: true,
        until_restart: false,
        inject: |contacts, _| contacts.samples.second_angle = LOW,
    },
    Fault {
        name: "second angle track 4 degrees off",
        most_ms: 22.0,
        always_shows: true,
        until_restart: false,
        inject: |contacts, _| {
            let off = contacts.samples.second_angle.get() + 119;
            contacts.samples.second_angle = code(off);
        },
    },
    Fault {
        name: "both angle tracks lost",
        most_ms: 7.0,
        always_shows: true,
        until_restart: false,
        inject: |contacts, _| {
            contacts.samples.rocker_angle = LOW;
            contacts.samples.second_angle = LOW;
        },
    },
    Fault {
        name: "angle jumps by 8 degrees",
        most_ms: 7.0,
        always_shows: false,
        until_restart: false,
        inject: |contacts, _| {
            let jumped = contacts.samples.rocker_angle.get() + 238;
            contacts.samples.rocker_angle = code(jumped);
        },
    },
    Fault {
        name: "lift coil open",
        most_ms: 42.0,
        always_shows: false,
        until_restart: false,
        inject: |contacts, _| contacts.samples.lift_current = LOW,
    },
    Fault {
        name: "lift coil shorted",
        most_ms: 12.0,
        always_shows: false,
        until_restart: true,
        inject: |contacts, _| contacts.samples.lift_current = HIGH,
    },
    Fault {
        name: "sensor supply at 4 V",
        most_ms: 22.0,
        always_shows: true,
        until_restart: false,
        inject: |contacts, _| {
            // Behind a divider of 2.
            contacts.samples.sensor_supply = code(2_482);
        },
    },
    Fault {
        name: "sensor supply shorted to ground",
        most_ms: 22.0,
        always_shows: true,
        until_restart: false,
        inject: |contacts, _| contacts.samples.sensor_supply = LOW,
    },
    Fault {
        name: "converter reference 8 % low",
        most_ms: 22.0,
        always_shows: true,
        until_restart: false,
        inject: |contacts, _| {
            let risen = u32::from(contacts.samples.reference.get()) * 100 / 92;
            contacts.samples.reference = code(risen as u16);
        },
    },
    Fault {
        name: "converter reference lost",
        most_ms: 22.0,
        always_shows: true,
        until_restart: false,
        inject: |contacts, _| contacts.samples.reference = HIGH,
    },
];

/// Injects each fault into a hitch that is lifted at full speed.
pub fn electrical_faults(setup: &Setup) -> Result<String> {
    let mut table = Vec::new();
    for fault in FAULTS {
        let Fault {
            name,
            most_ms,
            inject,
            ..
        } = fault;
        let took_ms = react(setup, inject).with_context(|| name.to_owned())?;
        ensure!(
            took_ms <= most_ms,
            "{name}: off after {took_ms:.2} ms, {most_ms} ms allowed"
        );
        table.push(format!("{name}: {took_ms:.2} ms"));
    }
    Ok(table.join("\n"))
}

fn react(setup: &Setup, inject: fn(&mut Contacts, usize)) -> Result<f64> {
    let model = hitch_model_file::nominal();
    let mut rig = Rig::typical(setup, &model)?;
    rig.pick_up()?;
    rig.lever(125.0, 700)?;
    ensure!(rig.is_driven(), "the hitch isn't lifted");
    let fault_ns = rig.now_ns();
    let mut step = 0;
    let took_ms = rig.off_after_ms(fault_ns, 300, |contacts| {
        inject(contacts, step);
        step += 1;
    })?;
    // Nothing comes back while the fault is there.
    for step in 0..200 {
        rig.tick_with(|contacts| inject(contacts, step))?;
        ensure!(!rig.is_driven(), "a coil is driven again {step} ms later");
    }
    ensure!(rig.board.resets.is_empty(), "the ECU was reset");
    Ok(took_ms)
}

/// The first angle track freezes while the hitch is lifted at full speed, to the last bit or with its noise: the second
/// one goes on, and their difference trips.
pub fn frozen_track(setup: &Setup) -> Result<String> {
    /// 2 degrees at 40 deg/s or more, the row's time, and two milliseconds.
    const MOST_MS: f64 = 60.0;
    let model = hitch_model_file::nominal();
    let mut worst_ms: f64 = 0.0;
    for trembles in [false, true] {
        let mut rig = Rig::typical(setup, &model)?;
        rig.pick_up()?;
        rig.lever(125.0, 700)?;
        let mut random = fastrand::Rng::with_seed(17);
        let mut frozen = None;
        let fault_ns = rig.now_ns();
        let took_ms = rig.off_after_ms(fault_ns, 300, |contacts| {
            let held = *frozen.get_or_insert(contacts.samples.rocker_angle.get());
            let noise = if trembles { random.u16(0..4) } else { 0 };
            contacts.samples.rocker_angle = code(held + noise);
        })?;
        ensure!(
            took_ms <= MOST_MS,
            "off after {took_ms} ms, {MOST_MS} ms allowed"
        );
        worst_ms = worst_ms.max(took_ms);
    }
    Ok(format!("pins low after at most {worst_ms:.1} ms"))
}

/// The enable line's read-back is stuck high or low from power-up on, or goes low in the middle of a move.
pub fn enable_line(setup: &Setup) -> Result<String> {
    let model = hitch_model_file::nominal();
    for stuck in [true, false] {
        let mut rig = Rig::typical(setup, &model)?;
        rig.board
            .chip()
            .conditions
            .levels
            .insert(ENABLE_READ_BACK, stuck);
        rig.pick_up()?;
        rig.bench.operator.apply(Order::Lever(110.0));
        for step in 0..1_000 {
            rig.tick_with(|_| {})?;
            ensure!(
                !rig.is_driven(),
                "stuck at {stuck}: a coil is driven after {step} ms"
            );
        }
        ensure!(
            rig.board.resets.is_empty(),
            "stuck at {stuck}: {:?}",
            rig.board.resets
        );
    }
    let mut rig = Rig::typical(setup, &model)?;
    rig.pick_up()?;
    rig.lever(125.0, 700)?;
    ensure!(rig.is_driven(), "the hitch isn't lifted");
    let fault_ns = rig.now_ns();
    rig.board
        .chip()
        .conditions
        .levels
        .insert(ENABLE_READ_BACK, false);
    let took_ms = rig.off_after_ms(fault_ns, 200, |_| {})?;
    ensure!(took_ms <= 8.0, "off after {took_ms} ms");
    Ok(format!(
        "no coil is driven with a stuck line; pins low after {took_ms:.1} ms in a move"
    ))
}
