//! Elements that effects attach as numbers: resistances, factors, ground, bristles, hoses.

/// A relief valve whose pressure increases with the flow through it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ReliefOverride {
    /// Pressure increase from cracking to the pump's full flow, Pa.
    pub override_pa: f64,
    /// Difference of the set pressure and the cracking pressure, Pa.
    pub below_setting_pa: f64,
}

/// A flow resistance in series with an orifice: a pipe, a filter, an open seat.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Line {
    /// Turbulent coefficient: pressure per square of the flow, Pa s2/m6.
    pub turbulent_pa_s2_m6: f64,
    /// Laminar coefficient: pressure per flow, Pa s/m3.
    pub laminar_pa_s_m3: f64,
}

impl Line {
    /// A line without resistance.
    pub const FREE: Self = Self {
        turbulent_pa_s2_m6: 0.0,
        laminar_pa_s_m3: 0.0,
    };

    /// Whether it has no resistance.
    #[inline(always)]
    #[must_use]
    pub fn is_free(&self) -> bool {
        *self == Self::FREE
    }

    /// Pressure drop, Pa, at a flow, m3/s.
    #[inline(always)]
    #[must_use]
    pub fn pressure_pa(&self, flow_m3_s: f64) -> f64 {
        (self.laminar_pa_s_m3 + self.turbulent_pa_s2_m6 * flow_m3_s) * flow_m3_s
    }

    /// Flow through an orifice in series with it, m3/s, at a pressure, Pa, that would drive `free_m3_s` through the
    /// orifice alone: the root of `p = (p / Q_free^2 + turbulent) Q^2 + laminar Q`.
    #[inline(always)]
    #[must_use]
    pub fn behind_orifice_m3_s(&self, free_m3_s: f64, pressure_pa: f64) -> f64 {
        let narrower = 1.0 + self.turbulent_pa_s2_m6 * free_m3_s * free_m3_s / pressure_pa;
        let half = 0.5 * self.laminar_pa_s_m3 * free_m3_s / pressure_pa;
        free_m3_s / (half + (half * half + narrower).sqrt())
    }
}

/// A factor on a valve's flow.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlowFactor {
    /// Factor at half the largest flow.
    pub at_half: f64,
    /// Increase of the factor from there to the largest flow.
    pub growth: f64,
}

impl Default for FlowFactor {
    fn default() -> Self {
        Self::ONE
    }
}

impl FlowFactor {
    /// No change of the flow.
    pub const ONE: Self = Self {
        at_half: 1.0,
        growth: 0.0,
    };

    /// The factor at a tabulated flow; the largest tabulated flow is `largest`.
    #[inline(always)]
    #[must_use]
    pub fn at(&self, flow: f64, largest: f64) -> f64 {
        if self.growth == 0.0 || largest <= 0.0 {
            return self.at_half;
        }
        self.at_half + self.growth * (2.0 * flow / largest - 1.0)
    }
}

/// Ground under the hitch: a unilateral spring and damper, whose damping is proportional to the depth (Hunt & Crossley
/// 1975) or independent of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ground {
    /// Height of the ground above the shaft, m, at which the hitch point touches it.
    pub height_m: f64,
    /// Stiffness, N/m.
    pub stiffness_n_m: f64,
    /// Depth-proportional damping, s/m: relative increase of the force per m/s of approach; dynamic plant only.
    pub damping_s_m: f64,
    /// Viscous damping, N s/m; dynamic plant only.
    pub damping_n_s_m: f64,
}

impl Ground {
    /// Force on the hitch point, N, upwards, at its height, m, and speed, m/s.
    #[inline(always)]
    #[must_use]
    pub fn force_n(&self, height_m: f64, speed_m_s: f64) -> f64 {
        let depth_m = self.height_m - height_m;
        if depth_m <= 0.0 {
            return 0.0;
        }
        let spring_n = self.stiffness_n_m * depth_m;
        let damped_n = spring_n * (1.0 - self.damping_s_m * speed_m_s);
        (damped_n - self.damping_n_s_m * speed_m_s).max(0.0)
    }
}

/// Dry friction with state: bristles between piston and seal deflect before they slip (Dahl 1968; LuGre with a
/// speed-independent level, Canudas de Wit 1995), and relax at rest due to vibration of the machine.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bristles {
    /// Friction force with slipping bristles, N.
    pub force_n: f64,
    /// Deflection of slipping bristles, m.
    pub reach_m: f64,
    /// Relaxation rate: speed of the piston at which the relaxation reduces the force by half, m/s.
    pub creep_m_s: f64,
}

impl Bristles {
    /// Deflection of the bristles, m, after the piston moved by `moved_m`: `z' = v - (|v| + creep) z / reach`, exact
    /// for a constant speed.
    #[inline(always)]
    #[must_use]
    pub fn bent_m(&self, before_m: f64, moved_m: f64, dt_s: f64) -> f64 {
        let share = (moved_m.abs() + self.creep_m_s * dt_s) / self.reach_m;
        if share <= 0.0 {
            return before_m;
        }
        let end_m = moved_m / share;
        end_m + (before_m - end_m) * (-share).exp()
    }
}

/// A hose whose wall expands with the pressure, partly at once and partly by creep (a spring in parallel with a spring
/// and damper, the standard linear solid; Ferry, Viscoelastic Properties of Polymers, 1980, ch. 1).
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Hose {
    /// Immediate compliance, m3/Pa.
    pub at_once_m3_pa: f64,
    /// Additional compliance after complete creep, m3/Pa.
    pub creeping_m3_pa: f64,
    /// Creep rate at constant pressure, 1/s, relative to the remaining creep.
    pub catching_up_1_s: f64,
}

impl Hose {
    /// A hose that does not expand.
    pub const STIFF: Self = Self {
        at_once_m3_pa: 0.0,
        creeping_m3_pa: 0.0,
        catching_up_1_s: 0.0,
    };

    /// Flow, m3/s, into its creeping wall, which lags behind the pressure by `behind_pa`.
    #[inline(always)]
    #[must_use]
    pub fn creep_m3_s(&self, behind_pa: f64) -> f64 {
        if self.creeping_m3_pa == 0.0 {
            0.0
        } else {
            self.creeping_m3_pa * self.catching_up_1_s * behind_pa
        }
    }

    /// Rate of the lag of its wall behind the pressure, Pa/s, at a rate of the pressure, Pa/s; zero without creep, so that
    /// a plant without hoses may come to rest at any pressure.
    #[inline(always)]
    #[must_use]
    pub fn behind_pa_s(&self, pressure_pa_s: f64, behind_pa: f64) -> f64 {
        if self.catching_up_1_s == 0.0 {
            0.0
        } else {
            pressure_pa_s - self.catching_up_1_s * behind_pa
        }
    }
}
