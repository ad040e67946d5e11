//! Deviations of a rig from its data sheet, as plain numbers; the default has none.

/// One play of a Prandtl-Ishlinskii operator.
#[derive(Debug, Clone, Copy)]
pub struct Play {
    /// Half of its width, A.
    pub half_width_a: f64,
    /// Its share of the output.
    pub share: f64,
}

/// A spool that sticks.
#[derive(Debug, Clone, Copy)]
pub struct Stiction {
    /// Current change that it takes to break loose, A.
    pub band_a: f64,
    /// How far the spool jumps then, A.
    pub jump_a: f64,
    /// Whether it follows the current once loose, until that turns back (Choudhury), or sticks again at once.
    pub follows: bool,
}

/// How a spool follows its current.
#[derive(Debug, Clone, Copy, Default)]
pub enum SpoolMotion {
    /// At once.
    #[default]
    Immediate,
    /// First-order lag with this time constant, s.
    Lagging(f64),
    /// Second order behind a dead time.
    Swinging {
        /// Natural frequency, rad/s.
        frequency_rad_s: f64,
        /// Damping ratio.
        damping: f64,
        /// Dead time, s.
        dead_time_s: f64,
    },
}

/// Steady flow force on the lowering spool.
#[derive(Debug, Clone, Copy, Default)]
pub struct FlowForce {
    /// Spring balance at the reference drop, `K dp_ref`.
    pub strength: f64,
    /// Whether it moves the spool along the table instead of scaling the opening.
    pub on_spool: bool,
}

/// Friction at the piston beyond the known viscous one.
#[derive(Debug, Clone, Copy, Default)]
pub struct Friction {
    /// Coulomb force, N.
    pub coulomb_n: f64,
    /// Additional force at rest, N.
    pub stribeck_n: f64,
    /// Speed over which that fades, m/s.
    pub stribeck_speed_m_s: f64,
    /// Whether it fades with the square of the speed (Gauss) or linearly in the exponent (Tustin).
    pub gaussian: bool,
    /// Whether bristles carry it (LuGre) or a hyperbolic tangent.
    pub bristles: bool,
    /// Whether bristles at rest creep back: few machines are free of vibration, test stands may be.
    pub trembles: bool,
    /// Viscous friction at 40 degC, N s/m.
    pub viscous_n_s_m: f64,
    /// Whether that grows with the root of the oil's viscosity.
    pub thickens: bool,
    /// Friction with the square of the speed, N s2/m2.
    pub square_n_s2_m2: f64,
    /// Force of a scored spot in the bore, N, and where it is, m.
    pub bump: (f64, f64),
}

/// The ground under the hitch.
#[derive(Debug, Clone, Copy)]
pub struct Ground {
    /// Its height over the hitch point's lowest place, m.
    pub height_m: f64,
    /// Stiffness, N/m.
    pub stiffness_n_m: f64,
    /// Damping, N s/m.
    pub damping_n_s_m: f64,
}

/// Instruments that deviate from their data sheet.
#[derive(Debug, Clone, Copy, Default)]
pub struct Sensors {
    /// Gain error of the angle.
    pub angle_gain: f64,
    /// Angle at which the gain error shows nothing, degree.
    pub angle_pivot_deg: f64,
    /// Lag of the angle, s.
    pub angle_lag_s: f64,
    /// Whether the lag is half dead time, half first order.
    pub angle_delayed: bool,
    /// Full width of the play between piston and sensor lever, m of piston travel.
    pub backlash_m: f64,
    /// Offset of the cylinder pressure, Pa.
    pub pressure_offset_pa: f64,
    /// Once-per-turn error of the angle: amplitude, degree; phase, rad.
    pub cam: (f64, f64),
}

/// Everything.
#[derive(Debug, Clone, Default)]
pub struct Physics {
    /// Threshold shift of the lift valve, A.
    pub lift_shift_a: f64,
    /// Threshold shift of the lowering valve, A.
    pub lower_shift_a: f64,
    /// Hysteresis of both solenoids; empty for none.
    pub plays: Vec<Play>,
    /// Stiction of both spools.
    pub stiction: Option<Stiction>,
    /// Dynamics of both spools in addition to those of the family.
    pub spool: SpoolMotion,
    /// Relative error of the lift valve's flow, at half and at full opening.
    pub lift_flow_error: (f64, f64),
    /// Relative error of the lowering valve's flow, at half and at full opening.
    pub lower_flow_error: (f64, f64),
    /// Flow force on the lowering spool.
    pub flow_force: FlowForce,
    /// Pressure margin lost over cylinder pressure, Pa/Pa.
    pub droop: f64,
    /// Share of the margin that is lost at the pump's full flow through the lift valve.
    pub droop_with_flow: f64,
    /// Lag of the compensator, s.
    pub compensator_lag_s: f64,
    /// Pressure loss of the check valve above its cracking pressure, Pa.
    pub check_loss_pa: f64,
    /// The same over flow, Pa s/m3.
    pub check_loss_pa_s_m3: f64,
    /// How long the check valve takes to seat, s.
    pub check_seating_s: f64,
    /// Slip of the pump, m3/s/Pa.
    pub pump_slip_m3_s_pa: f64,
    /// Pressure rise of the relief valve from cracking to the pump's full flow, Pa.
    pub relief_override_pa: f64,
    /// Leakage out of the cylinder, m3/s/Pa at 40 degC.
    pub leakage_m3_s_pa: f64,
    /// Whether the leakage goes with the oil's fluidity.
    pub leakage_thins: bool,
    /// Turbulent loss of the return line, Pa s2/m6.
    pub return_turbulent: f64,
    /// Laminar loss of the return line, Pa s/m3 at 40 degC.
    pub return_laminar: f64,
    /// Flow number of the change from laminar to turbulent flow in the spools; zero for none.
    pub laminar_flow_number: f64,
    /// Friction.
    pub friction: Friction,
    /// Friction of the pins, as a share of the weight force.
    pub pin_friction: f64,
    /// By how much that share changes over the stroke, as a share of itself.
    pub pin_friction_ripple: f64,
    /// How far behind the hitch point the load's centre of gravity is, m.
    pub load_arm_m: f64,
    /// The ground.
    pub ground: Option<Ground>,
    /// Additional inertia of load and piston, relative to that of the weights.
    pub inertia_share: f64,
    /// Moment of inertia on the rocker shaft that it does not have, kg m2.
    pub rocker_inertia_kg_m2: f64,
    /// Volume of free air over that of the oil at atmospheric pressure.
    pub air_ratio: f64,
    /// Polytropic exponent of that air, if there is any.
    pub air_exponent: f64,
    /// Relative change of the oil's compressibility.
    pub compressibility_error: f64,
    /// Compliance of the hose, m3/Pa.
    pub hose_m3_pa: f64,
    /// Retardation time of the hose's wall, s.
    pub hose_retardation_s: f64,
    /// Instruments.
    pub sensors: Sensors,
    /// Length of an end cushion at the bottom, m.
    pub cushion_m: f64,
    /// Relative change of both valves' flow per second since the campaign began.
    pub flow_drift_1_s: f64,
    /// Cam-like force at the piston outside the catalogue, N.
    pub unnamed_force_n: f64,
    /// Slow variation of the lowering valve's gain outside the catalogue.
    pub unnamed_wobble: f64,
}

impl Physics {
    /// Whether any force on the piston depends on its speed.
    #[must_use]
    pub fn is_slowed(&self) -> bool {
        let friction = &self.friction;
        let forces = [
            friction.coulomb_n,
            friction.stribeck_n,
            friction.viscous_n_s_m,
            friction.square_n_s2_m2,
            friction.bump.0,
            self.pin_friction,
        ];
        self.ground.is_some() || forces.iter().any(|&force| force != 0.0)
    }
}
