//! Draft and depth: pins, depth sensor, dial, selector and engagement switch at the board's inputs.

use anyhow::{Context as _, Result, ensure};
use hitch_ecu::{AdcCode, Contact, Contacts, Panel};
use hitch_protocols::j1939::Trouble;

use super::first_flash::{REPORTED_MS, reported, reports};
use super::rig::Rig;
use super::setup::Setup;
use crate::ecu_tool;

/// Lever in work, and where the implement touches the ground, degree.
const LEVER_DEG: f64 = 80.0;
const GROUND_DEG: f64 = 90.0;
/// Draft and depth for a degree below the ground, N and m.
const N_PER_DEG: f64 = 900.0;
const M_PER_DEG: f64 = 0.009;
/// The untaught calibration: force of both pins for a quarter of the supply, `draft.left_span` and `draft.right_span`; output of
/// the depth sensor at the ground, and depth for a quarter of the supply, `depth.zero` and `depth.span`.
const SPAN_N: f64 = 80_000.0;
const DEPTH_ZERO: f64 = 0.25;
const SPAN_M: f64 = 0.2;
/// Steps of the set point, `draft.step` and `depth.step`, degree.
const DRAFT_STEP_DEG: f64 = 4.5;
const DEPTH_STEP_DEG: f64 = 1.5;
/// `depth.dead_band`, m.
const DEPTH_BAND_M: f64 = 0.014;
/// Time within which storing ends, ms.
const STORED_MS: usize = 8_000;
/// Time in which a function has come to rest, ms.
const SETTLED_MS: usize = 8_000;

/// Wires of the sensors and the dial.
#[derive(Clone, Copy, Default)]
struct Wires {
    /// Position of the dial of the set point, 0 to 1.
    dial: f64,
    /// Broken wires.
    left_pin: bool,
    depth_sensor: bool,
}

impl Wires {
    fn connect(self, angle_deg: f64, step: usize, contacts: &mut Contacts) {
        let below_deg = (GROUND_DEG - angle_deg).max(0.0);
        // The last digits of a healthy sensor tremble.
        let code = |share: f64, phase: usize| {
            let tremble = (step + phase) % 3;
            AdcCode::new((share * 4096.0).round().clamp(0.0, 4093.0) as u16 + tremble as u16)
        };
        let unless = |broken: bool, code| if broken { AdcCode::default() } else { code };
        let pin = 0.5 + 0.25 * below_deg * N_PER_DEG / SPAN_N;
        let depth = DEPTH_ZERO + 0.25 * below_deg * M_PER_DEG / SPAN_M;
        let samples = &mut contacts.samples;
        samples.left_pin = unless(self.left_pin, code(pin, 0));
        samples.right_pin = code(pin, 1);
        samples.depth_sensor = unless(self.depth_sensor, code(depth, 2));
        samples.set_point_dial = code(0.1 + 0.8 * self.dial, 0);
    }

    fn run(self, rig: &mut Rig<'_>, milliseconds: usize) -> Result<()> {
        for step in 0..milliseconds {
            let angle_deg = rig.bench.angle_deg();
            rig.tick_with(|contacts| self.connect(angle_deg, step, contacts))?;
        }
        Ok(())
    }
}

/// Selects a function by one contact, or none.
fn select(rig: &mut Rig<'_>, contact: Option<Contact>) {
    let closed = |panel: Panel, contact| panel.with(contact, true);
    rig.bench.operator.panel = contact.into_iter().fold(Panel::FIELD, closed);
}

/// Stores that pins and depth sensor are fitted.
fn fit(rig: &mut Rig<'_>, wires: Wires) -> Result<()> {
    wires.run(rig, 250)?;
    ecu_tool::begin_service(&mut rig.bench, &mut rig.board)?;
    for group in ["draft", "depth"] {
        let word = ecu_tool::word(group, "fitted").context("no such parameter")?;
        ecu_tool::change(&mut rig.bench, &mut rig.board, word, 1)?;
    }
    ecu_tool::store(&mut rig.bench, &mut rig.board)?;
    for _ in 0..STORED_MS {
        rig.said.clear();
        wires.run(rig, 1)?;
        if ecu_tool::says_stored(&rig.said) {
            rig.board.cycle_power()?;
            return Ok(());
        }
    }
    anyhow::bail!("storing does not end")
}

/// A hitch in the soil by the lever, with pins and depth sensor.
fn in_the_soil(rig: &mut Rig<'_>, wires: Wires) -> Result<()> {
    fit(rig, wires)?;
    select(rig, None);
    wires.run(rig, 300)?;
    for lever_deg in [LEVER_DEG - 5.0, LEVER_DEG + 5.0, LEVER_DEG] {
        rig.bench.operator.lever_target_deg = lever_deg;
        wires.run(rig, 400)?;
    }
    wires.run(rig, 3_000)?;
    let off_deg = rig.bench.angle_deg() - LEVER_DEG;
    ensure!(off_deg.abs() < 1.0, "{off_deg} deg from the lever");
    let found = reported(&rig.said);
    ensure!(found.is_empty(), "healthy sensors, and {found:?}");
    Ok(())
}

/// Regulates to the set point of a dial, and returns how far below the ground the hitch then is, degree.
fn regulated(rig: &mut Rig<'_>, wires: Wires, contact: Contact) -> Result<f64> {
    select(rig, Some(contact));
    wires.run(rig, SETTLED_MS)?;
    Ok(GROUND_DEG - rig.bench.angle_deg())
}

/// A trouble in this state of wires: it is reported, and the hitch stays. Returns how far it moved, degree.
fn stays(rig: &mut Rig<'_>, wires: Wires, trouble: Trouble) -> Result<f64> {
    let before_deg = rig.bench.angle_deg();
    rig.said.clear();
    wires.run(rig, REPORTED_MS)?;
    let moved_deg = (rig.bench.angle_deg() - before_deg).abs();
    ensure!(reports(&rig.said, trouble), "{trouble:?} is not reported");
    ensure!(moved_deg < 3.0, "{trouble:?} moves it by {moved_deg} deg");
    Ok(moved_deg)
}

/// The selected draft or depth moves the hitch, a broken wire is reported, and the engagement switch lowers.
pub fn draft_and_depth(setup: &Setup) -> Result<String> {
    let mut rig = Rig::typical(setup)?;
    let wanted_n = 5_400.0;
    let wires = Wires {
        dial: wanted_n / SPAN_N,
        ..Wires::default()
    };
    in_the_soil(&mut rig, wires)?;
    let draft_n = N_PER_DEG * regulated(&mut rig, wires, Contact::Draft)?;
    ensure!(
        (draft_n - wanted_n).abs() < 0.5 * DRAFT_STEP_DEG * N_PER_DEG,
        "a draft of {draft_n} N, {wanted_n} wanted"
    );
    let broken = Wires {
        left_pin: true,
        ..wires
    };
    let pin_deg = stays(&mut rig, broken, Trouble::DraftPinMissing)?;

    let engaged_deg = engage(&mut rig, wires)?;

    let wanted_m = 0.054;
    let wires = Wires {
        dial: wanted_m / (2.0 * SPAN_M),
        ..wires
    };
    let depth_m = M_PER_DEG * regulated(&mut rig, wires, Contact::Depth)?;
    ensure!(
        (depth_m - wanted_m).abs() < DEPTH_BAND_M + DEPTH_STEP_DEG * M_PER_DEG,
        "a depth of {depth_m} m, {wanted_m} wanted"
    );
    let broken = Wires {
        depth_sensor: true,
        ..wires
    };
    let depth_deg = stays(&mut rig, broken, Trouble::DepthSensorMissing)?;
    rig.finish()?;
    Ok(format!(
        "{draft_n:.0} N of {wanted_n} and {depth_m:.3} m of {wanted_m} at the set point; {pin_deg:.2} deg after a broken pin, \
         {depth_deg:.2} after a broken depth sensor; engaged {engaged_deg:.1} deg below the ground"
    ))
}

/// Raises by quick lift, and lowers by the engagement switch. Returns how far below the ground the hitch then is, degree.
fn engage(rig: &mut Rig<'_>, wires: Wires) -> Result<f64> {
    select(rig, Some(Contact::Draft));
    let panel = rig.bench.operator.panel;
    rig.bench.operator.panel = panel.with(Contact::QuickLift, true);
    wires.run(rig, 4_000)?;
    let raised_deg = rig.bench.angle_deg();
    ensure!(raised_deg > GROUND_DEG + 20.0, "raised to {raised_deg} deg");
    rig.bench.operator.panel = panel;
    wires.run(rig, 500)?;
    rig.bench.operator.panel = panel.with(Contact::Engage, true);
    wires.run(rig, 4_000)?;
    rig.bench.operator.panel = panel;
    let below_deg = GROUND_DEG - rig.bench.angle_deg();
    ensure!(below_deg > 0.0, "{below_deg} deg below the ground");
    Ok(below_deg)
}

/// Conversions of the slow channels do not end any more: all their sensors are lost within one check, nothing hangs, and the
/// lever still moves the hitch.
pub fn stuck_conversions(setup: &Setup) -> Result<String> {
    let mut rig = Rig::typical(setup)?;
    let wires = Wires {
        dial: 0.07,
        ..Wires::default()
    };
    in_the_soil(&mut rig, wires)?;
    regulated(&mut rig, wires, Contact::Draft)?;
    for converter in &mut rig.board.chip().converters {
        converter.regular.is_stuck = true;
    }
    let moved_deg = stays(&mut rig, wires, Trouble::DraftPinMissing)?;
    select(&mut rig, None);
    rig.bench.operator.lever_target_deg = LEVER_DEG + 30.0;
    wires.run(&mut rig, 3_000)?;
    let off_deg = (rig.bench.angle_deg() - LEVER_DEG - 30.0).abs();
    ensure!(off_deg < 1.0, "{off_deg} deg from the lever");
    rig.finish()?;
    Ok(format!(
        "reported, moved by {moved_deg:.2} deg; {off_deg:.2} deg from the lever afterwards"
    ))
}
