//! From spool currents and cylinder pressure to flows and pump pressure.

use super::data_sheet::{
    CRACKING_PA, DENSITY_KG_M3, LIFT_REFERENCE_PA, LIFT_TABLE, LOWER_REFERENCE_PA, LOWER_TABLE,
    LPM, MARGIN_PA, PUMP_M3_S, RELIEF_PA, SPOOL_M_PER_A, viscosity_m2_s,
};
use super::physics::Physics;

/// Temperature at which laminar coefficients are stated, degC.
const REFERENCE_C: f64 = 40.0;

/// Flow through either valve at which it counts as fully open, m3/s.
const FULL_FLOW_M3_S: f64 = 40.0 * LPM;

/// How far a check poppet is open backwards, as a share of the lift valve's opening that it has just passed.
const UNSEATED_SHARE: f64 = 0.25;

/// The circuit in one run.
#[derive(Debug, Clone)]
pub struct Circuit<'a> {
    physics: &'a Physics,
    viscosity_m2_s: f64,
    /// Fluidity over that at the reference temperature.
    fluidity: f64,
    /// Pump pressure as a lagging compensator has it, Pa.
    pump_pressure_pa: f64,
    /// Backflow through the check valve until it is seated, m3/s at the reference drop.
    unseated_m3_s: f64,
    /// Factor on both valves' flow now: drift and wobble.
    flow_factors: (f64, f64),
    /// Factor of an end cushion on the lowering flow now.
    cushion: f64,
}

/// Flows and pump pressure.
#[derive(Debug, Clone, Copy, Default)]
pub struct Flows {
    /// Reading of the flow meter, m3/s, into the cylinder.
    pub metered_m3_s: f64,
    /// Flow into the cylinder, m3/s.
    pub net_m3_s: f64,
    /// Pump pressure, Pa.
    pub pump_pressure_pa: f64,
}

/// Currents that the two tables are read at, A.
#[derive(Debug, Clone, Copy, Default)]
pub struct Spools {
    /// Lift valve.
    pub lift_a: f64,
    /// Lowering valve.
    pub lower_a: f64,
}

impl Spools {
    /// Half-way between two places.
    #[must_use]
    pub fn middle(a: Self, b: Self) -> Self {
        Self {
            lift_a: 0.5 * (a.lift_a + b.lift_a),
            lower_a: 0.5 * (a.lower_a + b.lower_a),
        }
    }
}

impl<'a> Circuit<'a> {
    /// The circuit at rest.
    #[must_use]
    pub fn new(physics: &'a Physics, oil_temperature_c: f64) -> Self {
        let viscosity = viscosity_m2_s(oil_temperature_c);
        Self {
            physics,
            viscosity_m2_s: viscosity,
            fluidity: viscosity_m2_s(REFERENCE_C) / viscosity,
            pump_pressure_pa: MARGIN_PA,
            unseated_m3_s: 0.0,
            flow_factors: (1.0, 1.0),
            cushion: 1.0,
        }
    }

    /// Updates the slow states to a time since the start of the campaign, s, and a travel, m.
    pub fn set_slow(&mut self, since_s: f64, travel_m: f64) {
        let drift = 1.0 + self.physics.flow_drift_1_s * since_s;
        let wobble = 1.0 + self.physics.unnamed_wobble * (since_s / 7.0).sin();
        self.flow_factors = (drift, drift * wobble);
        self.cushion = if self.physics.cushion_m > 0.0 {
            // An annular gap that closes: the flow falls to a fifth over the cushion's length.
            0.2 + 0.8 * (travel_m / self.physics.cushion_m).clamp(0.0, 1.0)
        } else {
            1.0
        };
    }

    /// Flows at a cylinder pressure, Pa.
    #[must_use]
    pub fn flows(&self, spools: Spools, cylinder_pa: f64) -> Flows {
        let (lift_m3_s, pump_pressure_pa) = self.lift(spools.lift_a, cylinder_pa);
        let lower_m3_s = self.lower(spools.lower_a, cylinder_pa);
        let back_m3_s = if lift_m3_s > 0.0 {
            0.0
        } else {
            self.unseated_m3_s * (cylinder_pa.max(0.0) / LIFT_REFERENCE_PA).sqrt()
        };
        let leak_m3_s = self.leak(cylinder_pa);
        let metered_m3_s = lift_m3_s - lower_m3_s - back_m3_s;
        Flows {
            metered_m3_s,
            net_m3_s: metered_m3_s - leak_m3_s,
            pump_pressure_pa,
        }
    }

    /// Updates the lagging elements: compensator and check valve.
    pub fn advance(&mut self, spools: Spools, cylinder_pa: f64, dt_s: f64) {
        let share = |tau_s: f64| -(-dt_s / tau_s).exp_m1();
        let opening = self.lift_opening(spools.lift_a, LIFT_REFERENCE_PA);
        if self.physics.compensator_lag_s > 0.0 {
            let wanted = self.wanted_pump_pa(opening, cylinder_pa);
            self.pump_pressure_pa +=
                share(self.physics.compensator_lag_s) * (wanted - self.pump_pressure_pa);
        }
        if self.physics.check_seating_s > 0.0 {
            // While oil passes, the poppet is off its seat in proportion; without, it falls back slowly.
            let falling = self.unseated_m3_s * (1.0 - share(self.physics.check_seating_s));
            self.unseated_m3_s = falling.max(UNSEATED_SHARE * opening);
        }
    }

    /// Flow of the lift valve at its reference drop, m3/s.
    fn lift_opening(&self, current_a: f64, drop_pa: f64) -> f64 {
        let table_m3_s = LIFT_TABLE.flow_m3_s(current_a);
        table_m3_s
            * scaled(self.physics.lift_flow_error, table_m3_s)
            * self.flow_factors.0
            * self.turbulence(current_a - LIFT_TABLE.threshold_a, drop_pa)
    }

    /// Discharge of a narrow gap over that of a wide one, `tanh(2 lambda / lambda_c)` (McCloy & Martin).
    fn turbulence(&self, open_a: f64, drop_pa: f64) -> f64 {
        if self.physics.laminar_flow_number == 0.0 {
            return 1.0;
        }
        let diameter_m = 2.0 * SPOOL_M_PER_A * open_a.max(0.0);
        let speed_m_s = (2.0 * drop_pa.max(0.0) / DENSITY_KG_M3).sqrt();
        let flow_number = diameter_m * speed_m_s / self.viscosity_m2_s;
        (2.0 * flow_number / self.physics.laminar_flow_number).tanh()
    }

    fn margin_pa(&self, lift_m3_s: f64, cylinder_pa: f64) -> f64 {
        MARGIN_PA * (1.0 - self.physics.droop_with_flow * lift_m3_s / PUMP_M3_S)
            - self.physics.droop * cylinder_pa.max(0.0)
    }

    /// Pump pressure that the compensator settles at, Pa.
    fn wanted_pump_pa(&self, opening_m3_s: f64, cylinder_pa: f64) -> f64 {
        if opening_m3_s > 0.0 {
            (cylinder_pa + self.margin_pa(opening_m3_s, cylinder_pa)).min(RELIEF_PA)
        } else {
            MARGIN_PA
        }
    }

    /// Flow into the cylinder, m3/s, and pump pressure, Pa.
    fn lift(&self, current_a: f64, cylinder_pa: f64) -> (f64, f64) {
        let opening = self.lift_opening(current_a, LIFT_REFERENCE_PA);
        let mut wanted = self.wanted_pump_pa(opening, cylinder_pa);
        if self.physics.compensator_lag_s > 0.0 {
            wanted = self.pump_pressure_pa.min(RELIEF_PA);
        }
        if opening <= 0.0 {
            return (0.0, wanted);
        }
        let short =
            |pump_pa: f64| self.lift_flow(opening, pump_pa - cylinder_pa) - self.available(pump_pa);
        if short(wanted) <= 0.0 {
            return (self.lift_flow(opening, wanted - cylinder_pa), wanted);
        }
        // The compensator is closed and the pump delivers less than demanded: the pressure settles at the balance.
        let pump_pa = rising_root(short, cylinder_pa.max(0.0), wanted);
        (self.lift_flow(opening, pump_pa - cylinder_pa), pump_pa)
    }

    /// Flow of the lift valve for a drop from pump to cylinder, m3/s.
    fn lift_flow(&self, opening_m3_s: f64, drop_pa: f64) -> f64 {
        let free_pa = drop_pa - CRACKING_PA - self.physics.check_loss_pa;
        if free_pa <= 0.0 {
            return 0.0;
        }
        let slope = self.physics.check_loss_pa_s_m3;
        // q^2 = k (free - slope q) with k = opening^2 / reference.
        let k = opening_m3_s * opening_m3_s / LIFT_REFERENCE_PA;
        let half = 0.5 * k * slope;
        (half * half + k * free_pa).sqrt() - half
    }

    /// Flow of pump minus relief valve that is available to the lift valve, m3/s.
    fn available(&self, pump_pa: f64) -> f64 {
        let pumped = PUMP_M3_S - self.physics.pump_slip_m3_s_pa * pump_pa;
        let over = self.physics.relief_override_pa;
        let relieved = if over > 0.0 {
            PUMP_M3_S * ((pump_pa - RELIEF_PA + over) / over).max(0.0)
        } else {
            0.0
        };
        pumped - relieved
    }

    /// Lowering flow, m3/s, driven by the cylinder pressure minus the return line loss.
    fn lower(&self, current_a: f64, cylinder_pa: f64) -> f64 {
        let free = self.lower_flow(current_a, cylinder_pa);
        if free <= 0.0
            || (self.physics.return_turbulent == 0.0 && self.physics.return_laminar == 0.0)
        {
            return free;
        }
        let laminar = self.physics.return_laminar / self.fluidity;
        let excess = |flow: f64| {
            let back = (laminar + self.physics.return_turbulent * flow) * flow;
            flow - self.lower_flow(current_a, cylinder_pa - back)
        };
        rising_root(excess, 0.0, free)
    }

    /// Flow of the lowering valve for a drop, m3/s.
    fn lower_flow(&self, current_a: f64, drop_pa: f64) -> f64 {
        if drop_pa <= 0.0 {
            return 0.0;
        }
        let force = self.physics.flow_force;
        let relative = drop_pa / LOWER_REFERENCE_PA;
        let balance = (1.0 + force.strength) / (1.0 + force.strength * relative);
        let open_a = current_a - LOWER_TABLE.threshold_a;
        let (read_at_a, factor) = if force.on_spool {
            (LOWER_TABLE.threshold_a + open_a * balance, 1.0)
        } else {
            (current_a, balance)
        };
        let table_m3_s = LOWER_TABLE.flow_m3_s(read_at_a);
        table_m3_s
            * factor
            * scaled(self.physics.lower_flow_error, table_m3_s)
            * self.flow_factors.1
            * self.cushion
            * self.turbulence(open_a, drop_pa)
            * relative.sqrt()
    }

    fn leak(&self, cylinder_pa: f64) -> f64 {
        let thinned = if self.physics.leakage_thins {
            self.fluidity
        } else {
            1.0
        };
        self.physics.leakage_m3_s_pa * thinned * cylinder_pa.max(0.0)
    }

    /// Fluidity of the oil over that at 40 degC.
    #[must_use]
    pub fn fluidity(&self) -> f64 {
        self.fluidity
    }
}

/// Factor of a flow error that is stated at half and at full opening.
fn scaled((half, full): (f64, f64), table_m3_s: f64) -> f64 {
    let opening = (table_m3_s / FULL_FLOW_M3_S).min(1.5);
    1.0 + half + (full - half) * (2.0 * opening - 1.0)
}

/// Root of a rising function between two places, by false position with the stale end's value halved (Illinois).
#[must_use]
pub fn rising_root(f: impl Fn(f64) -> f64, low: f64, high: f64) -> f64 {
    let fine = 1e-9 * (high - low);
    let (mut low, mut high) = ((low, f(low)), (high, f(high)));
    if low.1 >= 0.0 {
        return low.0;
    }
    if high.1 <= 0.0 {
        return high.0;
    }
    let mut last_side = 0;
    for _ in 0..60 {
        let place = low.0 - low.1 * (high.0 - low.0) / (high.1 - low.1);
        let value = f(place);
        if value == 0.0 || high.0 - low.0 < fine {
            return place;
        }
        let side = if value < 0.0 { -1 } else { 1 };
        if side < 0 {
            low = (place, value);
            high.1 *= if last_side == side { 0.5 } else { 1.0 };
        } else {
            high = (place, value);
            low.1 *= if last_side == side { 0.5 } else { 1.0 };
        }
        last_side = side;
        if value.abs() < 1e-12 * (high.1 - low.1) {
            return place;
        }
    }
    0.5 * (low.0 + high.0)
}
