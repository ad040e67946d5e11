//! A first-order lag, of a spool or a sensor.

/// First-order lag `tau y' + y = u`, solved exactly for an input that changes linearly over a step.
///
/// With `tau = 0` the output is the input.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lag {
    time_constant_s: f64,
    input: f64,
    output: f64,
    /// Last step, s, and the decay factor over it: most steps are equal, and `exp` is expensive.
    decay: (f64, f64),
}

impl Lag {
    /// A lag at rest with `input`.
    #[must_use]
    pub fn at_rest(time_constant_s: f64, input: f64) -> Self {
        Self {
            time_constant_s,
            input,
            output: input,
            decay: (0.0, 1.0),
        }
    }

    /// Advances by `dt_s` while the input changes linearly to `input`; returns the output.
    #[inline]
    pub fn advance(&mut self, input: f64, dt_s: f64) -> f64 {
        let tau_s = self.time_constant_s;
        if tau_s > 0.0 && dt_s > 0.0 {
            // With u = u0 + s t a particular solution is u - s tau; the rest decays.
            if self.decay.0 != dt_s {
                self.decay = (dt_s, (-dt_s / tau_s).exp());
            }
            let trail = (input - self.input) / dt_s * tau_s;
            let rest = self.output - self.input + trail;
            self.output = input - trail + rest * self.decay.1;
        } else {
            self.output = input;
        }
        self.input = input;
        self.output
    }
}
