//! Flow of a proportional valve over solenoid current, as tabulated by a manufacturer.

/// A flow characteristic: increasing currents (A) and the flow (m3/s) at the valve's reference pressure drop.
///
/// Linear between the points, constant beyond the ends.
#[derive(Debug, Clone, PartialEq)]
pub struct ValveCurve {
    current_a: Vec<f64>,
    flow_m3_s: Vec<f64>,
    threshold_a: f64,
}

/// Error in the points of a [`ValveCurve`].
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum ValveCurveError {
    /// Fewer than two points, or lists of different lengths.
    #[error(
        "a valve curve needs at least two currents and as many flows, not {currents} and {flows}"
    )]
    Length {
        /// Number of currents given.
        currents: usize,
        /// Number of flows given.
        flows: usize,
    },
    /// The currents do not increase strictly, or a value is not a finite, non-negative number.
    #[error(
        "point {index} of a valve curve: currents must rise strictly, flows must not fall, and both be finite and not negative"
    )]
    Order {
        /// Index of the offending point, from zero.
        index: usize,
    },
}

impl ValveCurve {
    /// A curve through `(current_a, flow_m3_s)`.
    ///
    /// # Errors
    /// [`ValveCurveError`] unless currents increase strictly, flows never decrease and all are finite and not negative.
    pub fn new(current_a: Vec<f64>, flow_m3_s: Vec<f64>) -> Result<Self, ValveCurveError> {
        if current_a.len() != flow_m3_s.len() || current_a.len() < 2 {
            return Err(ValveCurveError::Length {
                currents: current_a.len(),
                flows: flow_m3_s.len(),
            });
        }
        for index in 0..current_a.len() {
            let (current, flow) = (current_a[index], flow_m3_s[index]);
            let valid = current.is_finite() && flow.is_finite() && current >= 0.0 && flow >= 0.0;
            let rises =
                index == 0 || (current > current_a[index - 1] && flow >= flow_m3_s[index - 1]);
            if !(valid && rises) {
                return Err(ValveCurveError::Order { index });
            }
        }
        Ok(Self::through(current_a, flow_m3_s))
    }

    /// A valve without flow at any current.
    #[must_use]
    pub fn shut() -> Self {
        Self::through(vec![0.0, 1.0], vec![0.0, 0.0])
    }

    fn through(current_a: Vec<f64>, flow_m3_s: Vec<f64>) -> Self {
        let first = flow_m3_s.iter().position(|&flow| flow > 0.0);
        let threshold_a = current_a[first.unwrap_or(flow_m3_s.len()).saturating_sub(1)];
        Self {
            current_a,
            flow_m3_s,
            threshold_a,
        }
    }

    /// Flow at the reference drop, m3/s, for a current in A.
    #[inline]
    #[must_use]
    pub fn flow_m3_s(&self, current_a: f64) -> f64 {
        // Valves are closed most of the time, and this is in the plant's innermost loop.
        let upper = if current_a > self.threshold_a {
            self.current_a
                .partition_point(|&point_a| point_a <= current_a)
        } else {
            0
        };
        if upper == 0 {
            return self.flow_m3_s[0];
        }
        if upper == self.current_a.len() {
            return self.flow_m3_s[upper - 1];
        }
        let (i0, i1) = (self.current_a[upper - 1], self.current_a[upper]);
        let (q0, q1) = (self.flow_m3_s[upper - 1], self.flow_m3_s[upper]);
        q0 + (q1 - q0) * ((current_a - i0) / (i1 - i0))
    }

    /// The tabulated currents, A.
    #[must_use]
    pub fn currents_a(&self) -> &[f64] {
        &self.current_a
    }

    /// The tabulated flows at the reference drop, m3/s.
    #[must_use]
    pub fn flows_m3_s(&self) -> &[f64] {
        &self.flow_m3_s
    }

    /// Current up to which the valve is closed, A: the last point without flow before the first one with flow.
    #[inline]
    #[must_use]
    pub fn threshold_a(&self) -> f64 {
        self.threshold_a
    }

    /// Smallest tabulated current with the largest flow, A.
    #[must_use]
    pub fn full_opening_a(&self) -> f64 {
        let saturation_m3_s = self.saturation_m3_s();
        let points = self.current_a.iter().zip(&self.flow_m3_s);
        let full = points.filter(|(_, flow_m3_s)| **flow_m3_s >= saturation_m3_s);
        full.map(|(current_a, _)| *current_a)
            .fold(f64::INFINITY, f64::min)
    }

    /// Largest flow at the reference drop, m3/s.
    #[inline]
    #[must_use]
    pub fn saturation_m3_s(&self) -> f64 {
        self.flow_m3_s[self.flow_m3_s.len() - 1]
    }
}
