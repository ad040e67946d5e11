//! Each electrical fault of the safety table, with its reaction time at the pin.

use anyhow::{Context, Result, ensure};
use hitch_firmware::ecu::{AdcCode, Contacts};
use hitch_model::Model;

use super::Setup;
use super::rig::Rig;

/// A fault of wires, sensors and coils: name, longest reaction at the pin in ms, and what it does to the samples.
type Fault = (&'static str, f64, fn(&mut Contacts, usize));

const fn code(code: u16) -> AdcCode {
    AdcCode::new(code)
}

/// Ends of the converters' range: a short to ground, and one to the supply.
const LOW: AdcCode = code(0);
const HIGH: AdcCode = code(4095);

/// The faults. A row's time from the table, a millisecond until it is sampled, and one to react.
const FAULTS: [Fault; 14] = [
    ("supply below 8 V", 12.0, |contacts, _| {
        contacts.samples.supply = code(7_400 / 6);
    }),
    ("supply above 16.8 V", 12.0, |contacts, _| {
        contacts.samples.supply = code(18_000 / 6);
    }),
    (
        "supply alternates each millisecond",
        12.0,
        |contacts, step| {
            if step % 2 == 0 {
                contacts.samples.supply = code(7_000 / 6);
            }
        },
    ),
    ("lever shorted to ground", 7.0, |contacts, _| {
        contacts.samples.lever = LOW
    }),
    ("lever shorted to its supply", 7.0, |contacts, _| {
        contacts.samples.lever = HIGH;
    }),
    ("angle shorted to ground", 7.0, |contacts, _| {
        contacts.samples.rocker_angle = LOW;
    }),
    ("angle shorted to its supply", 7.0, |contacts, _| {
        contacts.samples.rocker_angle = HIGH;
    }),
    ("angle jumps by 8 degrees", 7.0, |contacts, _| {
        let jumped = contacts.samples.rocker_angle.get() + 238;
        contacts.samples.rocker_angle = code(jumped);
    }),
    ("lift coil open", 42.0, |contacts, _| {
        contacts.samples.lift_current = LOW
    }),
    ("lift coil shorted, 1.5 A more", 12.0, |contacts, _| {
        // 5 A are full scale.
        let more = contacts.samples.lift_current.get() + 1_229;
        contacts.samples.lift_current = code(more.min(4_095));
    }),
    ("sensor supply at 4 V", 22.0, |contacts, _| {
        // Behind a divider of 2.
        contacts.samples.sensor_supply = code(2_482);
    }),
    ("sensor supply shorted to ground", 22.0, |contacts, _| {
        contacts.samples.sensor_supply = LOW;
    }),
    ("converter reference 8 % low", 22.0, |contacts, _| {
        let risen = u32::from(contacts.samples.reference.get()) * 100 / 92;
        contacts.samples.reference = code(risen as u16);
    }),
    ("converter reference lost", 22.0, |contacts, _| {
        contacts.samples.reference = HIGH;
    }),
];

/// Injects each fault into a hitch that is lifted at full speed.
pub fn electrical_faults(setup: &Setup) -> Result<String> {
    let mut table = Vec::new();
    for (name, most_ms, inject) in FAULTS {
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
    for step in 0..500 {
        rig.tick_with(|contacts| inject(contacts, step))?;
        ensure!(!rig.is_driven(), "a coil is driven again {step} ms later");
    }
    ensure!(rig.board.resets.is_empty(), "the ECU was reset");
    Ok(took_ms)
}
