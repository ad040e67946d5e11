//! Current regulation: duty cycle of a coil for the current that the envelope permits.
//!
//! ```text
//! u = R i* + kp e + sum(ki e)        e = i* + dither - i
//! duty = (u + Vf) / (supply + Vf)    Vf: the freewheeling diode's, while the driver is off
//! ```
//!
//! The first term is the voltage at rest. With a good estimate of the resistance the others act only while the current
//! changes. The estimate follows the integral while the current is constant: the resistance changes slowly with
//! temperature. A milliohm times a milliampere is a microvolt, so only the last line needs a division. Factors are
//! limited such that the compiler can prove that their product fits a word: a saturating product takes eight times as
//! long. The second and the third term are in [`pi`].
//!
//! Without a measured current only the first term remains.

pub mod pi;

use hitch_quantities::calibration::design_parameters::CurrentParameters;
use hitch_quantities::fixed::Divisor;
use hitch_quantities::units::{Duty, MilliAmp, MilliOhm, MilliVolt, Millisecond};
use hitch_quantities::{CoilCurrents, Duties, Inputs};

use pi::{Gains, ProportionalIntegral, VoltageRange};

/// Largest supply: with the voltage of the diode, a hundred times its microvolts still fit a word.
const MOST_SUPPLY: MilliVolt = MilliVolt(19_000);
/// Largest voltage of the diode.
const MOST_DROP: MilliVolt = MilliVolt(2_000);
/// Largest current.
const MOST_CURRENT: MilliAmp = MilliAmp(8_191);
/// Largest resistance.
const MOST_RESISTANCE: MilliOhm = MilliOhm(65_535);
/// Fractional bits of the estimated resistance, milliohm: a milliohm per second is one unit per millisecond, to 2 %.
const RESISTANCE_BITS: u32 = 10;
/// Smallest supply; nothing is regulated below it.
const LEAST_SUPPLY: MilliVolt = MilliVolt(1_000);
/// A request that changes by less than this is constant.
const STEADY: MilliAmp = MilliAmp(50);

/// Regulates both coils.
#[derive(Clone, Copy, Debug)]
pub struct Regulation {
    lift: Regulator,
    lower: Regulator,
    /// Phase of the dither.
    phase: Millisecond,
}

impl Regulation {
    /// Coils of nominal resistance, without current.
    #[must_use]
    pub const fn new(parameters: &CurrentParameters) -> Self {
        let regulator = Regulator::new(parameters);
        Self {
            lift: regulator,
            lower: regulator,
            phase: Millisecond::ZERO,
        }
    }

    /// One step with the currents that the envelope permits.
    pub fn drive(
        &mut self,
        passed: CoilCurrents,
        inputs: &Inputs,
        parameters: &CurrentParameters,
    ) -> Duties {
        let next = self.phase.next();
        self.phase = if next < parameters.dither_period {
            next
        } else {
            Millisecond::ZERO
        };
        let up = self.phase + self.phase < parameters.dither_period;
        let dither = if up {
            parameters.dither_amplitude
        } else {
            -parameters.dither_amplitude
        };
        let supply = inputs
            .supply
            .unwrap_or(parameters.assumed_supply)
            .limited(LEAST_SUPPLY, MOST_SUPPLY);
        let duty = |regulator: &mut Regulator, asked, measured| {
            regulator.drive(asked, dither, measured, supply, parameters)
        };
        Duties {
            lift: duty(&mut self.lift, passed.lift, inputs.lift_current),
            lower: duty(&mut self.lower, passed.lower, inputs.lower_current),
        }
    }

    /// Estimated resistance of the lift and the lowering coil with wiring and driver.
    #[must_use]
    pub fn resistances(&self) -> [MilliOhm; 2] {
        [self.lift, self.lower].map(|coil| coil.resistance())
    }
}

/// Voltage of a resistance, microvolt.
fn microvolts(resistance: MilliOhm, current: MilliAmp) -> i32 {
    let resistance = resistance.limited(MilliOhm::ZERO, MOST_RESISTANCE);
    let current = current.limited(-MOST_CURRENT, MOST_CURRENT);
    resistance.0.saturating_mul(current.0)
}

/// Regulates one coil.
#[derive(Clone, Copy, Debug)]
struct Regulator {
    pi: ProportionalIntegral,
    /// Resistance in 2^-10 milliohms.
    resistance: i32,
    /// The request at its last change, and the time since then.
    steady: MilliAmp,
    steady_for: Millisecond,
}

impl Regulator {
    const fn new(parameters: &CurrentParameters) -> Self {
        Self {
            pi: ProportionalIntegral::NEW,
            resistance: finely(parameters.nominal_resistance),
            steady: MilliAmp::ZERO,
            steady_for: Millisecond::ZERO,
        }
    }

    const fn resistance(&self) -> MilliOhm {
        MilliOhm(self.resistance >> RESISTANCE_BITS)
    }

    fn drive(
        &mut self,
        asked: MilliAmp,
        dither: MilliAmp,
        measured: Option<MilliAmp>,
        supply: MilliVolt,
        parameters: &CurrentParameters,
    ) -> Duty {
        if asked <= MilliAmp::ZERO {
            self.pi = ProportionalIntegral::NEW;
            self.steady = MilliAmp::ZERO;
            return Duty::ZERO;
        }
        let drop = parameters
            .freewheel_drop
            .limited(MilliVolt::ZERO, MOST_DROP);
        let drop_uv = drop.0.saturating_mul(1000);
        let rest_uv = microvolts(self.resistance(), asked);
        let voltage_uv = match measured {
            Some(measured) => {
                let given = VoltageRange {
                    least_uv: drop_uv.saturating_neg(),
                    most_uv: supply.0.saturating_mul(1000),
                };
                let error = asked + dither - measured;
                let voltage_uv = self.pi.step(Gains::of(parameters), error, rest_uv, &given);
                self.learn(asked, parameters);
                voltage_uv
            }
            None => rest_uv,
        };
        share(voltage_uv.saturating_add(drop_uv), supply + drop)
    }

    /// Moves a small part of the integral into the resistance.
    fn learn(&mut self, asked: MilliAmp, parameters: &CurrentParameters) {
        if (asked - self.steady).magnitude() > STEADY {
            self.steady = asked;
            self.steady_for = Millisecond::ZERO;
        }
        self.steady_for = self.steady_for.next();
        if self.steady_for < parameters.settling_time {
            return;
        }
        let change = match self.pi.integral_uv() {
            ..0 => parameters.adaptation.0.saturating_neg(),
            0 => 0,
            1.. => parameters.adaptation.0,
        };
        self.resistance = self
            .resistance
            .saturating_add(change)
            .max(finely(parameters.lowest_resistance))
            .min(finely(parameters.highest_resistance));
    }
}

/// An estimated resistance.
const fn finely(resistance: MilliOhm) -> i32 {
    resistance.0 << RESISTANCE_BITS
}

/// Share of a voltage that gives another one, limited to that one.
fn share(part_uv: i32, whole: MilliVolt) -> Duty {
    let whole = whole.limited(LEAST_SUPPLY, MOST_SUPPLY + MOST_DROP).0;
    let part_uv = part_uv.max(0).min(whole.saturating_mul(1000));
    Duty(Divisor::at_least_one(whole).divide(part_uv.saturating_mul(100)))
}
