//! Each electrical fault of the safety table, with its reaction time at the pin.

use anyhow::{Context, Result, ensure};
use hitch_firmware::ecu::{AdcCode, Contacts};
use hitch_model::Model;

use super::Setup;
use super::rig::Rig;

/// A fault of wires, sensors and coils.
#[derive(Clone, Copy)]
pub struct Fault {
    /// What it is.
    pub name: &'static str,
    /// Longest reaction at the pin, ms: the row's time, a millisecond until it is sampled, and one to react.
    pub most_ms: f64,
    /// Whether it shows in any state: a coil's faults only show while it is driven, a jump is over once it has happened.
    pub always_shows: bool,
    /// What it does to the samples, in the step of this number.
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
        inject: |contacts, _| contacts.samples.supply = code(7_400 / 6),
    },
    Fault {
        name: "supply above 16.8 V",
        most_ms: 12.0,
        always_shows: true,
        inject: |contacts, _| contacts.samples.supply = code(18_000 / 6),
    },
    Fault {
        name: "supply alternates each millisecond",
        most_ms: 12.0,
        always_shows: true,
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
        inject: |contacts, _| contacts.samples.lever = LOW,
    },
    Fault {
        name: "lever shorted to its supply",
        most_ms: 7.0,
        always_shows: true,
        inject: |contacts, _| contacts.samples.lever = HIGH,
    },
    Fault {
        name: "angle shorted to ground",
        most_ms: 7.0,
        always_shows: true,
        inject: |contacts, _| contacts.samples.rocker_angle = LOW,
    },
    Fault {
        name: "angle shorted to its supply",
        most_ms: 7.0,
        always_shows: true,
        inject: |contacts, _| contacts.samples.rocker_angle = HIGH,
    },
    Fault {
        name: "second angle track shorted to ground",
        most_ms: 7.0,
        always_shows: true,
        inject: |contacts, _| contacts.samples.second_angle = LOW,
    },
    Fault {
        name: "second angle track 4 degrees off",
        most_ms: 22.0,
        always_shows: true,
        inject: |contacts, _| {
            let off = contacts.samples.second_angle.get() + 119;
            contacts.samples.second_angle = code(off);
        },
    },
    Fault {
        name: "both angle tracks lost",
        most_ms: 7.0,
        always_shows: true,
        inject: |contacts, _| {
            contacts.samples.rocker_angle = LOW;
            contacts.samples.second_angle = LOW;
        },
    },
    Fault {
        name: "angle jumps by 8 degrees",
        most_ms: 7.0,
        always_shows: false,
        inject: |contacts, _| {
            let jumped = contacts.samples.rocker_angle.get() + 238;
            contacts.samples.rocker_angle = code(jumped);
        },
    },
    Fault {
        name: "lift coil open",
        most_ms: 42.0,
        always_shows: false,
        inject: |contacts, _| contacts.samples.lift_current = LOW,
    },
    Fault {
        name: "lift coil shorted",
        most_ms: 12.0,
        always_shows: false,
        inject: |contacts, _| contacts.samples.lift_current = HIGH,
    },
    Fault {
        name: "sensor supply at 4 V",
        most_ms: 22.0,
        always_shows: true,
        inject: |contacts, _| {
            // Behind a divider of 2.
            contacts.samples.sensor_supply = code(2_482);
        },
    },
    Fault {
        name: "sensor supply shorted to ground",
        most_ms: 22.0,
        always_shows: true,
        inject: |contacts, _| contacts.samples.sensor_supply = LOW,
    },
    Fault {
        name: "converter reference 8 % low",
        most_ms: 22.0,
        always_shows: true,
        inject: |contacts, _| {
            let risen = u32::from(contacts.samples.reference.get()) * 100 / 92;
            contacts.samples.reference = code(risen as u16);
        },
    },
    Fault {
        name: "converter reference lost",
        most_ms: 22.0,
        always_shows: true,
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
    let model = Model::nominal();
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
