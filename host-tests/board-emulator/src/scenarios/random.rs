//! Random operation with faults: an operator who moves the hitch most of the time, intermittent wire breaks, a busy
//! bus.

use anyhow::{Result, ensure};
use hitch_ecu::Contact;
use hitch_ecu_host::ecu::Order;

use super::faults::{FAULTS, Fault};
use super::rig::{READY_MS, Rig};
use super::setup::Setup;

/// Names the minutes of machine time; a release runs 60.
const MINUTES_VARIABLE: &str = "HITCH_BOARD_MINUTES";
const MINUTES: f64 = 0.25;
const SEED: u64 = 20_261_124;
/// A persistent fault of any row has cut the coils by then, ms: the slowest row, and the state before.
const CUT_MS: u32 = 60;
/// Once a fault is gone, ms: everything has to be healthy for half a second before the hitch can be picked up.
const CALM_MS: u32 = 600;
/// The hand that moves the lever, degree a millisecond.
const HAND_DEG_PER_MS: f64 = 0.06;
/// How far the lever goes to either side of the hitch to pick it up, degree.
const ASIDE_DEG: f64 = 3.0;
/// Share of the time in which a coil has to be driven.
const LEAST_DRIVEN: f64 = 0.2;

/// Runs it; both coils are never driven together, a fault cuts them, nothing resets the ECU, and the hitch moves much.
pub fn operation(setup: &Setup) -> Result<String> {
    let minutes =
        std::env::var(MINUTES_VARIABLE).map_or(Ok(MINUTES), |text| text.parse::<f64>())?;
    let mut shift = Shift {
        rig: Rig::typical(setup)?,
        random: fastrand::Rng::with_seed(SEED),
        step: 0,
        driven_ms: 0,
    };
    shift.healthy(READY_MS as u32)?;
    let (mut faults, mut in_motion, mut restarts) = (0_u32, 0_u32, 0_u32);
    while f64::from(shift.step) < minutes * 60e3 {
        shift.pick_up()?;
        let moves_ms = shift.random.u32(1_500..6_000);
        shift.operate(moves_ms, None)?;
        let fault = &FAULTS[shift.random.usize(0..FAULTS.len())];
        let fault_ms = shift.random.u32(50..1_000);
        faults += 1;
        in_motion += u32::from(shift.rig.is_driven());
        shift.operate(fault_ms, Some(fault))?;
        shift.healthy(CALM_MS)?;
        if fault.until_restart {
            restarts += 1;
            shift.rig.board.cycle_power()?;
            shift.healthy(READY_MS as u32)?;
        }
    }
    shift.rig.finish()?;
    let share = f64::from(shift.driven_ms) / f64::from(shift.step);
    let said = format!(
        "seed {SEED}, {minutes} minutes: {faults} faults, {in_motion} of them in motion, {restarts} restarts, a coil driven for {:.1} s, {:.0} % of the time",
        f64::from(shift.driven_ms) * 1e-3,
        share * 100.0
    );
    ensure!(
        share >= LEAST_DRIVEN && in_motion > 0,
        "too little motion: {said}"
    );
    Ok(said)
}

/// The board, and a summary of events.
struct Shift<'m> {
    rig: Rig<'m>,
    random: fastrand::Rng,
    /// Milliseconds so far.
    step: u32,
    /// In so many of them a coil was driven.
    driven_ms: u32,
}

impl Shift<'_> {
    /// A millisecond with a fault that has been there for some.
    fn tick(&mut self, fault: Option<(&Fault, u32)>) -> Result<()> {
        let step = self.step;
        self.rig.said.clear();
        self.rig.tick_with(|contacts| {
            if let Some((fault, _)) = fault {
                (fault.inject)(&mut contacts.samples, step as usize);
            }
        })?;
        let chip = self.rig.board.chip();
        let both = chip.duty(0) > 0.0 && chip.duty(1) > 0.0;
        ensure!(!both, "seed {SEED}: both coils are driven after {step} ms");
        let driven = self.rig.is_driven();
        self.driven_ms += u32::from(driven);
        if let Some((fault, since_ms)) = fault
            && since_ms > CUT_MS
            && fault.always_shows
        {
            let name = fault.name;
            ensure!(
                !driven,
                "seed {SEED}: a coil is driven after {step} ms with {name}"
            );
        }
        ensure!(
            self.rig.board.resets.is_empty(),
            "seed {SEED}: reset after {step} ms"
        );
        self.step += 1;
        Ok(())
    }

    /// Some milliseconds in which the operator does nothing more.
    fn healthy(&mut self, milliseconds: u32) -> Result<()> {
        (0..milliseconds).try_for_each(|_| self.tick(None))
    }

    /// The lever goes through the hitch, to one side of it and to the other.
    fn pick_up(&mut self) -> Result<()> {
        let operator = &mut self.rig.bench.operator;
        operator.apply(Order::Buttons(false, false));
        operator.apply(Order::Contact(Contact::FieldMode, true));
        let angle_deg = self.rig.bench.angle_deg();
        for aside_deg in [-ASIDE_DEG, ASIDE_DEG] {
            let operator = &mut self.rig.bench.operator;
            let to_deg = (angle_deg + aside_deg).clamp(45.0, 135.0);
            let way_deg = (to_deg - operator.lever_deg).abs();
            operator.apply(Order::Lever(to_deg));
            self.healthy((way_deg / HAND_DEG_PER_MS) as u32 + 50)?;
        }
        Ok(())
    }

    /// Some milliseconds in which the operator does one thing after another.
    fn operate(&mut self, milliseconds: u32, fault: Option<&Fault>) -> Result<()> {
        let mut left_ms = 0;
        for since_ms in 0..milliseconds {
            if left_ms == 0 {
                left_ms = self.random.u32(50..2_000);
                self.act();
            }
            left_ms -= 1;
            self.tick(fault.map(|fault| (fault, since_ms)))?;
        }
        Ok(())
    }

    /// Something that an operator does: most often a move.
    fn act(&mut self) {
        let angle_deg = self.rig.bench.angle_deg();
        let random = &mut self.random;
        let operator = &mut self.rig.bench.operator;
        operator.apply(Order::Buttons(false, false));
        operator.apply(Order::Contact(Contact::FieldMode, true));
        match random.u32(0..20) {
            0 => operator.apply(Order::Buttons(true, false)),
            1 => operator.apply(Order::Buttons(false, true)),
            2 => operator.apply(Order::Contact(Contact::FieldMode, false)),
            3 | 4 => operator.apply(Order::Lever(angle_deg)),
            _ => operator.apply(Order::Lever(50.0 + 80.0 * random.f64())),
        }
    }
}
