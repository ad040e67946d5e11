//! The bring-up on a desk: LEDs in place of the coils, a potentiometer as the lever, and an angle that stands still.

use anyhow::{Result, ensure};
use hitch_ecu::{AdcCode, BoardScaling, Contact, Contacts};
use hitch_protocols::j1939::Trouble;
use hitch_workbench::ecu::Order;

use super::Setup;
use super::first_flash::{REPORTED_MS, reported};
use super::rig::{READY_MS, Rig};

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

/// Milliseconds in which lift and lowering LED are lit.
fn run(rig: &mut Rig<'_>, wires: &mut Wires, milliseconds: usize) -> Result<[usize; 2]> {
    let mut lit = [0; 2];
    for _ in 0..milliseconds {
        let chip = rig.board.chip();
        let duties = [chip.duty(0), chip.duty(1)];
        for (lit, duty) in lit.iter_mut().zip(duties) {
            *lit += usize::from(duty > 0.0);
        }
        rig.tick_with(|contacts| wires.connect(duties, contacts))?;
    }
    Ok(lit)
}

/// Turns the potentiometer to the middle and up, and then to the middle and down; what is to be seen.
fn turn(setup: &Setup, filtered: bool) -> Result<([usize; 2], Vec<Trouble>)> {
    let model = hitch_model_file::nominal();
    let mut rig = Rig::typical(setup, &model)?;
    let mut wires = Wires {
        currents: [0.0; 2],
        filtered,
    };
    let field = |closed| Order::Contact(Contact::FieldMode, closed);
    rig.bench.operator.apply(field(false));
    rig.bench.operator.apply(Order::Lever(80.0));
    let mut lit = run(&mut rig, &mut wires, READY_MS + 1_000)?;
    for lever_deg in [100.0, 80.0] {
        rig.bench.operator.apply(Order::Lever(lever_deg));
        lit = run(&mut rig, &mut wires, 1_000)?;
    }
    ensure!(lit == [0, 0], "an LED is lit in the transport lock");
    rig.bench.operator.apply(field(true));
    run(&mut rig, &mut wires, 500)?;
    let mut longest = [0; 2];
    for lever_deg in [92.0, 115.0, 88.0, 65.0] {
        rig.bench.operator.apply(Order::Lever(lever_deg));
        let lit = run(&mut rig, &mut wires, 2_000)?;
        longest = [longest[0].max(lit[0]), longest[1].max(lit[1])];
    }
    run(&mut rig, &mut wires, REPORTED_MS)?;
    rig.finish()?;
    Ok((longest, reported(&rig.said)))
}

/// The LEDs without and with the filters that stand in for the coils' currents.
pub fn bring_up(setup: &Setup) -> Result<String> {
    let mut lines = Vec::new();
    for (what, filtered) in [("no current", false), ("filters", true)] {
        let ([lift_ms, lower_ms], troubles) = turn(setup, filtered)?;
        lines.push(format!(
            "{what}: lift LED {lift_ms} ms, lowering LED {lower_ms} ms; reported {troubles:?}"
        ));
    }
    Ok(lines.join("\n"))
}
