//! The external buttons, with two antivalent contacts each.

use anyhow::{Context as _, Result, ensure};
use hitch_ecu::Contact;
use hitch_ecu_host::ecu::Order;
use hitch_protocols::j1939::Trouble;

use super::first_flash::{REPORTED_MS, reported, reports};
use super::rig::{READY_MS, Rig};
use super::setup::Setup;

/// `rate.longest_travel` of the factory calibration, degree.
const LONGEST_DEG: f64 = 30.0;
/// Time in which a press covers its longest travel at its slowest, and the hitch has come to rest, ms.
const PRESS_MS: usize = 8_000;
/// What the hitch may move after its coil was cut, degree: the valve closes, and the oil comes to rest.
const RUN_ON_DEG: f64 = 0.5;
/// Release that readies a button, ms.
const RELEASE_MS: usize = 100;

/// Holds a button, and returns how far the hitch moved, degree, up or down.
fn press(rig: &mut Rig<'_>, up: bool) -> Result<f64> {
    let from_deg = rig.bench.angle_deg();
    rig.bench.operator.apply(Order::Buttons(up, !up));
    rig.run(PRESS_MS)?;
    ensure!(!rig.is_driven(), "the press still drives a coil");
    Ok((rig.bench.angle_deg() - from_deg).abs())
}

/// Held for ever, a button moves the hitch by its longest travel, and by no more until it is released and pressed again.
pub fn longest_travel(setup: &Setup) -> Result<String> {
    let mut rig = Rig::typical(setup)?;
    rig.run(READY_MS)?;
    let mut furthest_deg: f64 = 0.0;
    for up in [true, false, true] {
        let moved_deg = press(&mut rig, up)?;
        ensure!(
            (0.8 * LONGEST_DEG..=LONGEST_DEG + RUN_ON_DEG).contains(&moved_deg),
            "a press moves the hitch by {moved_deg} deg, up to {LONGEST_DEG} are allowed; reported: {:?}",
            reported(&rig.said)
        );
        furthest_deg = furthest_deg.max(moved_deg);
        rig.bench.operator.apply(Order::Buttons(false, false));
        rig.run(RELEASE_MS)?;
    }
    rig.finish()?;
    Ok(format!(
        "a press moves the hitch by at most {furthest_deg:.2} deg, and again after a release"
    ))
}

/// A fault of the contacts: its description, its time after the start, ms, the contacts, and its trouble code.
type ContactFault<'a> = (&'a str, usize, &'a [(Contact, bool)], Trouble);

/// Contacts that say nothing of a press: no coil is driven, and a trouble code says why.
pub fn contacts(setup: &Setup) -> Result<String> {
    let closed_at_power_up: &[(Contact, bool)] =
        &[(Contact::Up, true), (Contact::UpReleased, false)];
    let cases: [ContactFault<'_>; 4] = [
        (
            "pressed since power-up",
            0,
            closed_at_power_up,
            Trouble::ButtonClosed,
        ),
        (
            "up shorted to ground",
            READY_MS,
            &[(Contact::Up, true)],
            Trouble::ButtonContacts,
        ),
        (
            "down shorted to ground",
            READY_MS,
            &[(Contact::Down, true)],
            Trouble::ButtonContacts,
        ),
        (
            "second contact of up broken",
            READY_MS,
            &[(Contact::UpReleased, false)],
            Trouble::ButtonContacts,
        ),
    ];
    for (what, at_ms, contacts, trouble) in cases {
        let mut rig = Rig::typical(setup)?;
        rig.run(at_ms)?;
        for &(contact, closed) in contacts {
            rig.bench.operator.apply(Order::Contact(contact, closed));
        }
        rig.run(READY_MS + 2 * REPORTED_MS)?;
        let fails = || what.to_owned();
        (|| {
            ensure!(!rig.was_driven, "a coil was driven");
            ensure!(reports(&rig.said, trouble), "{trouble:?} is not reported");
            rig.finish()
        })()
        .with_context(fails)?;
    }
    Ok(format!("{} faults: no coil driven, reported", cases.len()))
}
