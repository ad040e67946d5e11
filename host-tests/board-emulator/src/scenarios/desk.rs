//! The bring-up on a desk: LEDs in place of the coils, a potentiometer as the lever, and an angle that stands still.

use anyhow::{Result, ensure};
use hitch_ecu::{AdcCode, BoardScaling, Contact, Contacts};
use hitch_ecu_host::ecu::Order;
use hitch_protocols::j1939::Trouble;

use super::first_flash::{reported, reports};
use super::rig::{READY_MS, Rig};
use super::setup::Setup;

/// Supply and sensor supply that 3.3 V are on NUCLEO-G474RE, mV.
const SUPPLY_MV: f64 = 13_200.0;
const SENSOR_SUPPLY_MV: f64 = 5_000.0;
/// 10 kohm and 470 nF from a pulse output to the input of its current, ms.
const FILTER_MS: f64 = 4.7;

/// The wires of the table in `firmware/BOARD.md`.
struct Wires {
    /// Voltages at the inputs of both currents, as a share of the reference.
    currents: [f64; 2],
    /// The filters are fitted; otherwise both inputs are at ground.
    filtered: bool,
}

impl Wires {
    fn connect(&mut self, duties: [f64; 2], contacts: &mut Contacts) {
        let code = |share: f64| AdcCode::new((share * 4096.0).round().clamp(0.0, 4095.0) as u16);
        for (current, duty) in self.currents.iter_mut().zip(duties) {
            let settled = if self.filtered { duty } else { 0.0 };
            *current += (settled - *current) * (1.0 - (-1.0 / FILTER_MS).exp());
        }
        let nominal = BoardScaling::NOMINAL;
        let samples = &mut contacts.samples;
        samples.supply = code(SUPPLY_MV / f64::from(nominal.supply.0));
        samples.sensor_supply = code(SENSOR_SUPPLY_MV / f64::from(nominal.sensor_supply.0));
        [samples.lift_current, samples.lower_current] = self.currents.map(code);
        let middle = code(0.5);
        samples.rocker_angle = middle;
        samples.second_angle = middle;
        samples.lowering_dial = middle;
        samples.cylinder_pressure = middle;
        samples.pump_pressure = middle;
        samples.upper_limit = code(1.0);
    }
}

/// Longest flash before an open coil is a fault, ms: the time of row 12, and a sample at each end.
const OPEN_COIL_MS: usize = 42;
/// Time in which the potentiometer is turned, the fault occurs, and the next DM1 is sent, ms.
const TURNED_MS: usize = 1_500;

/// How long lift and lowering LED were lit, ms, one entry a flash.
type Flashes = [Vec<usize>; 2];

/// Dark milliseconds that end a flash.
const DARK_MS: usize = 10;

/// The flashes within some milliseconds.
fn run(rig: &mut Rig<'_>, wires: &mut Wires, milliseconds: usize) -> Result<Flashes> {
    let mut flashes = Flashes::default();
    let mut dark_ms = [DARK_MS; 2];
    for _ in 0..milliseconds {
        let chip = rig.board.chip();
        let duties = [chip.duty(0), chip.duty(1)];
        for ((flashes, dark_ms), duty) in flashes.iter_mut().zip(&mut dark_ms).zip(duties) {
            match flashes.last_mut() {
                _ if duty <= 0.0 => *dark_ms += 1,
                Some(lit_ms) if *dark_ms < DARK_MS => (*lit_ms, *dark_ms) = (*lit_ms + 1, 0),
                _ => {
                    flashes.push(1);
                    *dark_ms = 0;
                }
            }
        }
        rig.tick_with(|contacts| wires.connect(duties, contacts))?;
    }
    Ok(flashes)
}

/// A desk that is powered up: the potentiometer is turned up and down in the transport lock, and nothing is lit. Then field
/// mode is closed.
fn powered_up(setup: &Setup, filtered: bool) -> Result<(Rig<'_>, Wires)> {
    let mut rig = Rig::typical(setup)?;
    let mut wires = Wires {
        currents: [0.0; 2],
        filtered,
    };
    let field = |closed| Order::Contact(Contact::FieldMode, closed);
    rig.bench.operator.apply(field(false));
    rig.bench.operator.apply(Order::Lever(80.0));
    run(&mut rig, &mut wires, READY_MS)?;
    for lever_deg in [100.0, 80.0] {
        rig.bench.operator.apply(Order::Lever(lever_deg));
        run(&mut rig, &mut wires, 400)?;
    }
    ensure!(!rig.was_driven, "an LED is lit in the transport lock");
    rig.bench.operator.apply(field(true));
    run(&mut rig, &mut wires, 100)?;
    ensure!(!rig.was_driven, "an LED is lit before the lever is moved");
    Ok((rig, wires))
}

/// Turns the potentiometer, and lets go of it.
fn turn(
    rig: &mut Rig<'_>,
    wires: &mut Wires,
    lever_deg: f64,
    milliseconds: usize,
) -> Result<Flashes> {
    rig.bench.operator.apply(Order::Lever(lever_deg));
    run(rig, wires, milliseconds)
}

/// No current flows: an LED is lit until row 12 trips, and its code is reported. Returns the longest flash, ms.
fn without_current(setup: &Setup) -> Result<usize> {
    let (mut rig, mut wires) = powered_up(setup, false)?;
    let mut longest_ms = 0;
    for lever_deg in [115.0, 65.0] {
        let flashes = turn(&mut rig, &mut wires, lever_deg, TURNED_MS)?;
        longest_ms = flashes.into_iter().flatten().fold(longest_ms, usize::max);
    }
    rig.finish()?;
    ensure!(
        (1..=OPEN_COIL_MS).contains(&longest_ms),
        "an LED is lit for {longest_ms} ms, and no current flows"
    );
    let open = [Trouble::LiftCoilOpen, Trouble::LoweringCoilOpen];
    ensure!(
        open.iter().any(|trouble| reports(&rig.said, *trouble)),
        "no open coil is reported: {:?}",
        reported(&rig.said)
    );
    Ok(longest_ms)
}

/// With the filters the coil counts as connected. The lift LED is lit for longer, until the angle that stands still is a fault.
/// Returns its longest flash, ms.
fn with_filters(setup: &Setup) -> Result<usize> {
    let (mut rig, mut wires) = powered_up(setup, true)?;
    let [lift, _] = turn(&mut rig, &mut wires, 115.0, TURNED_MS)?;
    let longest_ms = lift.into_iter().fold(0, usize::max);
    ensure!(
        longest_ms > OPEN_COIL_MS,
        "the lift LED is lit for {longest_ms} ms at most; reported: {:?}",
        reported(&rig.said)
    );
    ensure!(!rig.is_driven(), "an LED is still lit");
    ensure!(
        reports(&rig.said, Trouble::AngleFrozen),
        "a frozen angle is not reported: {:?}",
        reported(&rig.said)
    );
    rig.finish()?;
    Ok(longest_ms)
}

/// Steps 1 to 3 of the bring-up.
pub fn bring_up(setup: &Setup) -> Result<String> {
    let without_ms = without_current(setup)?;
    let with_ms = with_filters(setup)?;
    Ok(format!(
        "an LED is lit for up to {without_ms} ms without current, and for {with_ms} ms with the filters"
    ))
}
