//! An instance of a unit: its component, the values of its variables, and where it is in its life.

use std::ffi::CString;

use super::logger::Logger;
use super::types::{Status, ValueReference};
use crate::component::{Component, Refusal};
use crate::variable::{Causality, Value, Variable};

/// Deviation of a point in time that counts as rounding, relative to the larger of it and 1 s.
const ROUNDING: f64 = 1e-9;

/// Where an instance is in its life.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Phase {
    /// Before initialisation: values are set.
    Instantiated,
    /// Within initialisation.
    Initialising,
    /// Steps are taken.
    Stepping,
    /// After the end.
    Terminated,
    /// After an error: it can be read, reset or freed.
    Failed,
}

/// What a function refuses.
#[derive(Debug)]
pub struct Fault {
    /// The status that it returns.
    pub status: Status,
    /// What is wrong and how to correct it.
    pub message: String,
}

impl Fault {
    /// A fault with `Status::Error`.
    pub fn error(message: impl Into<String>) -> Self {
        Self {
            status: Status::Error,
            message: message.into(),
        }
    }

    /// A fault with `Status::Discard`.
    pub fn discard(message: impl Into<String>) -> Self {
        Self {
            status: Status::Discard,
            message: message.into(),
        }
    }
}

/// Everything that a stored state holds.
pub struct Stored {
    component: Box<dyn Component>,
    values: Vec<Value>,
    slopes: Vec<f64>,
    phase: Phase,
    stale: bool,
    start_s: f64,
    time_s: f64,
    stop_s: Option<f64>,
}

/// An instance.
pub struct Instance {
    pub logger: Logger,
    now: Stored,
    /// Texts that were handed out last.
    pub texts: Vec<CString>,
}

impl Instance {
    /// An instance with the values of the start.
    pub fn new(component: Box<dyn Component>, logger: Logger) -> Self {
        let values: Vec<Value> = component
            .variables()
            .iter()
            .map(|variable| variable.start.clone())
            .collect();
        Self {
            logger,
            now: Stored {
                slopes: vec![0.0; values.len()],
                values,
                component,
                phase: Phase::Instantiated,
                stale: true,
                start_s: 0.0,
                time_s: 0.0,
                stop_s: None,
            },
            texts: Vec::new(),
        }
    }

    /// Refuses a call that the standard does not allow now.
    pub fn only_in(&self, phases: &[Phase]) -> Result<(), Fault> {
        if phases.contains(&self.now.phase) {
            Ok(())
        } else {
            Err(Fault::error(format!(
                "it may not be called in the state {:?}; it may be in {phases:?}",
                self.now.phase
            )))
        }
    }

    /// Goes on to another phase.
    pub fn enter(&mut self, phase: Phase) {
        self.now.phase = phase;
    }

    /// The present point in time, s.
    pub const fn time_s(&self) -> f64 {
        self.now.time_s
    }

    /// Sets when the simulation begins and ends.
    pub fn set_times(&mut self, start_s: f64, stop_s: Option<f64>) -> Result<(), Fault> {
        let is_later = stop_s.is_none_or(|stop_s| stop_s >= start_s);
        if !start_s.is_finite() || !is_later {
            return Err(Fault::error(format!(
                "the simulation would go from {start_s} s to {stop_s:?}; let the end be after a finite start"
            )));
        }
        (self.now.start_s, self.now.time_s, self.now.stop_s) = (start_s, start_s, stop_s);
        Ok(())
    }

    fn variable(&self, reference: ValueReference) -> Result<&Variable, Fault> {
        let variables = self.now.component.variables();
        usize::try_from(reference)
            .ok()
            .and_then(|index| variables.get(index))
            .ok_or_else(|| {
                Fault::error(format!(
                    "value reference {reference} is not known; modelDescription.xml has those below {}",
                    variables.len()
                ))
            })
    }

    /// The value of a variable. Outputs are calculated during initialisation as well.
    pub fn get(&mut self, reference: ValueReference) -> Result<&Value, Fault> {
        self.variable(reference)?;
        if self.now.phase == Phase::Initialising {
            self.initialise()
                .map_err(|Refusal(why)| Fault::discard(why))?;
        }
        Ok(&self.now.values[reference as usize])
    }

    /// Sets a variable to a value of its type.
    pub fn set(&mut self, reference: ValueReference, value: Value) -> Result<(), Fault> {
        let phase = self.now.phase;
        let variable = self.variable(reference)?;
        let name = &variable.name;
        let fault = |why: &str| Err(Fault::error(format!("{name} {why}")));
        match variable.causality {
            Causality::Output => return fault("is an output; set inputs and parameters"),
            Causality::Parameter if phase == Phase::Stepping => {
                return fault("is a fixed parameter; set it before the end of initialisation");
            }
            Causality::Parameter | Causality::Input => (),
        }
        if std::mem::discriminant(&value) != std::mem::discriminant(&variable.start) {
            return fault("has another type; see modelDescription.xml");
        }
        if let Value::Real(number) = value {
            variable.check(number).map_err(Fault::discard)?;
        }
        let index = reference as usize;
        self.now.values[index] = value;
        self.now.stale = true;
        Ok(())
    }

    /// Sets the rate of change of an input, 1/s.
    pub fn set_slope(&mut self, reference: ValueReference, slope: f64) -> Result<(), Fault> {
        let variable = self.variable(reference)?;
        if variable.causality != Causality::Input || !variable.is_continuous() {
            let name = &variable.name;
            return Err(Fault::error(format!(
                "{name} is no real input; it has no derivative"
            )));
        }
        if !slope.is_finite() {
            return Err(Fault::discard(format!(
                "the derivative of {} is {slope}; set a finite one",
                variable.name
            )));
        }
        self.now.slopes[reference as usize] = slope;
        Ok(())
    }

    /// Begins anew with the present values, unless that has been done.
    pub fn initialise(&mut self) -> Result<(), Refusal> {
        if self.now.stale {
            self.now.component.initialise(&mut self.now.values)?;
            self.now.stale = false;
        }
        Ok(())
    }

    /// Advances from `from_s` by `dt_s`.
    pub fn step(&mut self, from_s: f64, dt_s: f64) -> Result<(), Fault> {
        let now = &mut self.now;
        let slack_s = ROUNDING * from_s.abs().max(1.0);
        let gap_s = (from_s - now.time_s).abs();
        if gap_s.is_nan() || gap_s > slack_s {
            return Err(Fault::error(format!(
                "the step begins at {from_s} s, but the last one ended at {} s; go on from there",
                now.time_s
            )));
        }
        if !(dt_s > 0.0 && dt_s.is_finite()) {
            return Err(Fault::error(format!(
                "the communication step is {dt_s} s; take a positive one"
            )));
        }
        if let Some(stop_s) = now.stop_s.filter(|stop_s| from_s + dt_s > stop_s + slack_s) {
            return Err(Fault::error(format!(
                "the step would end at {} s, after the stop time of {stop_s} s; take a shorter one",
                from_s + dt_s
            )));
        }
        now.component
            .step(&mut now.values, &now.slopes, dt_s)
            .map_err(|Refusal(why)| Fault::error(why))?;
        now.time_s = from_s + dt_s;
        // An importer gives derivatives for one step.
        now.slopes.fill(0.0);
        Ok(())
    }

    /// As after instantiation.
    pub fn reset(&mut self) {
        let now = &mut self.now;
        let starts = now.component.variables().iter();
        now.values = starts.map(|variable| variable.start.clone()).collect();
        now.slopes.fill(0.0);
        (now.phase, now.stale) = (Phase::Instantiated, true);
        (now.start_s, now.time_s, now.stop_s) = (0.0, 0.0, None);
    }

    /// A copy of everything.
    pub fn store(&self) -> Stored {
        self.now.copy()
    }

    /// Goes back to a stored state.
    pub fn restore(&mut self, stored: &Stored) {
        self.now = stored.copy();
    }
}

impl Stored {
    fn copy(&self) -> Self {
        Self {
            component: self.component.copy(),
            values: self.values.clone(),
            slopes: self.slopes.clone(),
            phase: self.phase,
            stale: self.stale,
            start_s: self.start_s,
            time_s: self.time_s,
            stop_s: self.stop_s,
        }
    }
}
