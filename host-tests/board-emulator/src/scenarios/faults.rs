//! Each electrical fault of the safety table, with its reaction time at the pin.

use anyhow::{Context, Result, ensure};
use hitch_ecu::{AdcCode, Samples};
use hitch_ecu_host::ecu::Order;

use super::rig::Rig;
use super::setup::Setup;
use crate::Conditions;

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
    pub inject: fn(&mut Samples, usize),
}

impl Fault {
    /// A fault that shows in any state, and ends with its cause.
    const fn new(name: &'static str, most_ms: f64, inject: fn(&mut Samples, usize)) -> Self {
        Self {
            name,
            most_ms,
            always_shows: true,
            until_restart: false,
            inject,
        }
    }

    /// The same, which does not show in every state.
    const fn at_times(self) -> Self {
        Self {
            always_shows: false,
            ..self
        }
    }
}

const fn code(code: u16) -> AdcCode {
    AdcCode::new(code)
}

/// A code that is higher by some counts.
const fn above(of: AdcCode, counts: u16) -> AdcCode {
    code(of.get() + counts)
}

/// Ends of the converters' range: a short to ground, and one to the supply.
const LOW: AdcCode = code(0);
const HIGH: AdcCode = code(4095);

/// The faults.
#[rustfmt::skip]
pub const FAULTS: [Fault; 17] = [
    Fault::new("supply below 8 V", 12.0, |samples, _| samples.supply = code(7_400 / 6)),
    Fault::new("supply above 16.8 V", 12.0, |samples, _| samples.supply = code(18_000 / 6)),
    Fault::new("supply alternates each millisecond", 12.0, |samples, step| {
        if step % 2 == 0 {
            samples.supply = code(7_000 / 6);
        }
    }),
    Fault::new("lever shorted to ground", 7.0, |samples, _| samples.lever = LOW),
    Fault::new("lever shorted to its supply", 7.0, |samples, _| samples.lever = HIGH),
    Fault::new("angle shorted to ground", 7.0, |samples, _| samples.rocker_angle = LOW),
    Fault::new("angle shorted to its supply", 7.0, |samples, _| samples.rocker_angle = HIGH),
    Fault::new("second angle track shorted to ground", 7.0, |samples, _| samples.second_angle = LOW),
    Fault::new("second angle track 4 degrees off", 22.0, |samples, _| {
        samples.second_angle = above(samples.second_angle, 119);
    }),
    Fault::new("both angle tracks lost", 7.0, |samples, _| {
        [samples.rocker_angle, samples.second_angle] = [LOW; 2];
    }),
    Fault::new("angle jumps by 8 degrees", 7.0, |samples, _| {
        samples.rocker_angle = above(samples.rocker_angle, 238);
    }).at_times(),
    Fault::new("lift coil open", 42.0, |samples, _| samples.lift_current = LOW).at_times(),
    Fault {
        until_restart: true,
        ..Fault::new("lift coil shorted", 12.0, |samples, _| samples.lift_current = HIGH).at_times()
    },
    // Behind a divider of 2.
    Fault::new("sensor supply at 4 V", 22.0, |samples, _| samples.sensor_supply = code(2_482)),
    Fault::new("sensor supply shorted to ground", 22.0, |samples, _| samples.sensor_supply = LOW),
    Fault::new("converter reference 8 % low", 22.0, |samples, _| {
        samples.reference = code((u32::from(samples.reference.get()) * 100 / 92) as u16);
    }),
    Fault::new("converter reference lost", 22.0, |samples, _| samples.reference = HIGH),
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

fn react(setup: &Setup, inject: fn(&mut Samples, usize)) -> Result<f64> {
    let mut rig = Rig::lifted(setup, Conditions::typical(setup.layout))?;
    let fault_ns = rig.now_ns();
    let mut step = 0;
    let took_ms = rig.off_after_ms(fault_ns, 300, |contacts| {
        inject(&mut contacts.samples, step);
        step += 1;
    })?;
    // Nothing comes back while the fault is there.
    rig.stays_off(200, |contacts, step| inject(&mut contacts.samples, step))?;
    ensure!(rig.board.resets.is_empty(), "the ECU was reset");
    Ok(took_ms)
}

/// The first angle track freezes while the hitch is lifted at full speed, to the last bit or with its noise: the second
/// one goes on, and their difference trips.
pub fn frozen_track(setup: &Setup) -> Result<String> {
    /// 2 degrees at 40 deg/s or more, the row's time, and two milliseconds.
    const MOST_MS: f64 = 60.0;
    let mut worst_ms: f64 = 0.0;
    for trembles in [false, true] {
        let mut rig = Rig::lifted(setup, Conditions::typical(setup.layout))?;
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
    for stuck in [true, false] {
        let mut rig = Rig::typical(setup)?;
        rig.force_read_back(stuck);
        rig.pick_up()?;
        rig.bench.operator.apply(Order::Lever(110.0));
        rig.stays_off(1_000, |_, _| {})
            .with_context(|| format!("stuck at {stuck}"))?;
        ensure!(
            rig.board.resets.is_empty(),
            "stuck at {stuck}: {:?}",
            rig.board.resets
        );
    }
    let mut rig = Rig::lifted(setup, Conditions::typical(setup.layout))?;
    let fault_ns = rig.now_ns();
    rig.force_read_back(false);
    let took_ms = rig.off_after_ms(fault_ns, 200, |_| {})?;
    ensure!(took_ms <= 8.0, "off after {took_ms} ms");
    Ok(format!(
        "no coil is driven with a stuck line; pins low after {took_ms:.1} ms in a move"
    ))
}
