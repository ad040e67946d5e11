//! Current regulation: which share of the supply gives a coil the current that the envelope lets pass.
//!
//! ```text
//! u = R i* + kp e + sum(ki e)        e = i* + dither - i
//! duty = (u + Vf) / (supply + Vf)    Vf: the freewheeling diode's, while the driver is off
//! ```
//!
//! The first term is what the coil needs at rest; with a good estimate of its resistance the others are only busy when
//! the current changes. The estimate follows what the integral has to add while the current is steady: resistance
//! changes with temperature, which is slow. A milliohm times a milliampere is a microvolt, so none of this
//! needs a division but the last line.
//!
//! Without a measured current the first term alone remains.

use super::design_parameters::CurrentParameters;
use super::fixed::Divisor;
use super::safety::CoilCurrents;
use super::signals::Inputs;
use super::units::{Duty, MilliAmp, MilliOhm, MilliVolt, Millisecond};

/// Highest supply that is reckoned with: with the diode's drop, a hundred times its microvolts still fit.
const MOST_SUPPLY: MilliVolt = MilliVolt(19_000);
/// Lowest: below it nothing is regulated anyway.
const LEAST_SUPPLY: MilliVolt = MilliVolt(1_000);
/// A request that moves less than this is steady.
const STEADY: MilliAmp = MilliAmp(50);

/// Shares of the supply for both coils.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Duties {
    /// Lift coil.
    pub lift: Duty,
    /// Lowering coil.
    pub lower: Duty,
}

/// Regulates both coils.
#[derive(Clone, Copy, Debug)]
pub struct Regulation {
    lift: Regulator,
    lower: Regulator,
    /// Where in its period the dither is.
    phase: Millisecond,
}

impl Regulation {
    /// Coils of nominal resistance, without current.
    #[must_use]
    pub fn new(parameters: &CurrentParameters) -> Self {
        let regulator = Regulator::new(parameters);
        Self {
            lift: regulator,
            lower: regulator,
            phase: Millisecond::ZERO,
        }
    }

    /// One step with the currents that the envelope lets pass.
    pub fn drive(
        &mut self,
        passed: CoilCurrents,
        inputs: &Inputs,
        parameters: &CurrentParameters,
    ) -> Duties {
        let next = self.phase.next();
        self.phase = match next < parameters.dither_period {
            true => next,
            false => Millisecond::ZERO,
        };
        let up = self.phase + self.phase < parameters.dither_period;
        let dither = match up {
            true => parameters.dither_amplitude,
            false => -parameters.dither_amplitude,
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

/// Regulates one coil.
#[derive(Clone, Copy, Debug)]
struct Regulator {
    integral_uv: i32,
    resistance_uohm: i32,
    /// The request when it last changed, and how long ago.
    steady: MilliAmp,
    steady_for: Millisecond,
}

impl Regulator {
    fn new(parameters: &CurrentParameters) -> Self {
        Self {
            integral_uv: 0,
            resistance_uohm: parameters.nominal_resistance.0.saturating_mul(1000),
            steady: MilliAmp::ZERO,
            steady_for: Millisecond::ZERO,
        }
    }

    fn resistance(&self) -> MilliOhm {
        MilliOhm(Divisor::THOUSAND.divide(self.resistance_uohm))
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
            self.integral_uv = 0;
            self.steady = MilliAmp::ZERO;
            return Duty::ZERO;
        }
        let most_uv = supply.0.saturating_mul(1000);
        let rest_uv = self.resistance().0.saturating_mul(asked.0);
        let voltage_uv = match measured {
            Some(measured) => {
                let error = asked + dither - measured;
                self.regulated(rest_uv, error, most_uv, parameters)
            }
            None => rest_uv,
        };
        if measured.is_some() {
            self.learn(asked, parameters);
        }
        let drop = parameters.freewheel_drop;
        let over_drop_uv = voltage_uv.saturating_add(drop.0.saturating_mul(1000));
        let whole = supply + drop;
        let share_uv = over_drop_uv.max(0).min(whole.0.saturating_mul(1000));
        Duty(Divisor::at_least_one(whole.0).divide(share_uv.saturating_mul(100)))
    }

    /// The voltage with its proportional and integral parts; the integral stops where the supply ends.
    fn regulated(
        &mut self,
        rest_uv: i32,
        error: MilliAmp,
        most_uv: i32,
        parameters: &CurrentParameters,
    ) -> i32 {
        let proportional_uv = parameters.proportional.0.saturating_mul(error.0);
        let change_uv = parameters.integral.0.saturating_mul(error.0);
        let integral_uv = self.integral_uv.saturating_add(change_uv);
        let voltage_uv = rest_uv
            .saturating_add(proportional_uv)
            .saturating_add(integral_uv);
        let outwards = (voltage_uv > most_uv && change_uv > 0) || (voltage_uv < 0 && change_uv < 0);
        if !outwards {
            self.integral_uv = integral_uv.max(most_uv.saturating_neg()).min(most_uv);
        }
        voltage_uv
    }

    /// Moves what the integral has to add into the resistance, a little a step.
    fn learn(&mut self, asked: MilliAmp, parameters: &CurrentParameters) {
        if (asked - self.steady).magnitude() > STEADY {
            self.steady = asked;
            self.steady_for = Millisecond::ZERO;
        }
        self.steady_for = self.steady_for.next();
        if self.steady_for < parameters.settling_time {
            return;
        }
        // A milliohm a second is a microohm a millisecond.
        let change = self
            .integral_uv
            .signum()
            .saturating_mul(parameters.adaptation.0);
        let low = parameters.lowest_resistance.0.saturating_mul(1000);
        let high = parameters.highest_resistance.0.saturating_mul(1000);
        self.resistance_uohm = self
            .resistance_uohm
            .saturating_add(change)
            .max(low)
            .min(high);
    }
}
