//! Equations of motion of the machine.

use super::machine::{
    AREA_M2, BULK_MODULUS_PA, CRACKING_PA, DEAD_VOLUME_M3, DEAD_WEIGHT_KG, GRAVITY_M_S2,
    LIFT_CURVE, LIFT_REFERENCE_PA, LIMIT_PA, LOWER_CURVE, LOWER_REFERENCE_PA, MARGIN_PA, PISTON_KG,
    PUMP_M3_S, PUMP_RESPONSE_S, SPOOL_LAG_S, STANDBY_PA, STROKE_M, TRANSITION_PA, VISCOUS_N_S_M,
    Wear, flow_m3_s, transmission,
};

/// Step, s.
pub const STEP_S: f64 = 0.25e-3;

/// Travel, speed, cylinder pressure, pump pressure, current of the lift spool and of the lowering spool, SI.
type State = [f64; 6];

/// The machine in motion.
#[derive(Debug, Clone)]
pub struct Motion {
    load_kg: f64,
    wear: Wear,
    state: State,
}

impl Motion {
    /// The machine at rest with a load, kg, at a travel, m.
    #[must_use]
    pub fn at_rest(load_kg: f64, wear: Wear, travel_m: f64) -> Self {
        let (slope, _) = transmission(travel_m);
        let held_n = (load_kg + DEAD_WEIGHT_KG) * GRAVITY_M_S2 * slope;
        Self {
            load_kg,
            wear,
            state: [travel_m, 0.0, held_n / AREA_M2, STANDBY_PA, 0.0, 0.0],
        }
    }

    /// A step with the currents of lift and lowering coil, A: classical Runge-Kutta.
    pub fn step(&mut self, currents_a: [f64; 2]) {
        let rate = |state: &State| self.rate(state, currents_a);
        let ahead = |state: &State, rate: &State, dt_s: f64| -> State {
            std::array::from_fn(|k| state[k] + dt_s * rate[k])
        };
        let k1 = rate(&self.state);
        let k2 = rate(&ahead(&self.state, &k1, 0.5 * STEP_S));
        let k3 = rate(&ahead(&self.state, &k2, 0.5 * STEP_S));
        let k4 = rate(&ahead(&self.state, &k3, STEP_S));
        let mean = std::array::from_fn(|k| (k1[k] + 2.0 * (k2[k] + k3[k]) + k4[k]) / 6.0);
        self.state = ahead(&self.state, &mean, STEP_S);
        let travel_m = self.state[0].clamp(0.0, STROKE_M);
        if travel_m != self.state[0] {
            (self.state[0], self.state[1]) = (travel_m, 0.0);
        }
    }

    fn rate(&self, state: &State, [lift_a, lower_a]: [f64; 2]) -> State {
        let &[
            travel_m,
            speed_m_s,
            pressure_pa,
            pump_pa,
            lift_spool_a,
            lower_spool_a,
        ] = state;
        let lift = flow_m3_s(&LIFT_CURVE, lift_spool_a);
        let lower = flow_m3_s(&LOWER_CURVE, lower_spool_a);
        let asked_pa = if lift > 0.0 {
            (pressure_pa + MARGIN_PA).min(LIMIT_PA)
        } else {
            STANDBY_PA
        };
        let lifted = orifice(lift, pump_pa - pressure_pa - CRACKING_PA, LIFT_REFERENCE_PA);
        let leaked = self.wear.leakage_m3_s(pressure_pa);
        let net = -leaked + lifted.min(PUMP_M3_S) - orifice(lower, pressure_pa, LOWER_REFERENCE_PA);
        let (slope, bend) = transmission(travel_m);
        let hung_kg = self.load_kg + DEAD_WEIGHT_KG;
        let inertia_kg = hung_kg * slope * slope + PISTON_KG;
        let force_n = pressure_pa * AREA_M2
            - hung_kg * GRAVITY_M_S2 * slope
            - hung_kg * slope * bend * speed_m_s * speed_m_s
            - VISCOUS_N_S_M * speed_m_s;
        let volume_m3 = DEAD_VOLUME_M3 + AREA_M2 * travel_m;
        [
            speed_m_s,
            force_n / inertia_kg,
            BULK_MODULUS_PA / volume_m3 * (net - AREA_M2 * speed_m_s),
            (asked_pa - pump_pa) / PUMP_RESPONSE_S,
            (lift_a - lift_spool_a) / SPOOL_LAG_S,
            (lower_a - lower_spool_a) / SPOOL_LAG_S,
        ]
    }

    /// Travel, m.
    #[must_use]
    pub fn travel_m(&self) -> f64 {
        self.state[0]
    }

    /// Pressure of cylinders and pump, Pa.
    #[must_use]
    pub fn pressures_pa(&self) -> [f64; 2] {
        [self.state[2], self.state[3]]
    }
}

/// Flow through a valve over a drop, Pa, in m3/s; laminar below the transition drop.
fn orifice(reference_m3_s: f64, drop_pa: f64, reference_pa: f64) -> f64 {
    if drop_pa <= 0.0 {
        return 0.0;
    }
    let law = |drop_pa: f64| drop_pa / drop_pa.hypot(TRANSITION_PA).sqrt();
    reference_m3_s * law(drop_pa) / law(reference_pa)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Speed, m/s, over the last tenth of a second of half a second with constant currents.
    fn speed_m_s(load_kg: f64, currents_a: [f64; 2]) -> f64 {
        let mut motion = Motion::at_rest(load_kg, Wear::Worn, 0.1);
        for _ in 0..1600 {
            motion.step(currents_a);
        }
        let before_m = motion.travel_m();
        for _ in 0..400 {
            motion.step(currents_a);
        }
        (motion.travel_m() - before_m) / 0.1
    }

    #[test]
    fn a_compensated_lift_is_as_fast_with_any_load() {
        let expected =
            flow_m3_s(&LIFT_CURVE, 0.9) * ((MARGIN_PA - CRACKING_PA) / LIFT_REFERENCE_PA).sqrt();
        for load_kg in [400.0, 2000.0] {
            let speed = speed_m_s(load_kg, [0.9, 0.0]);
            assert!((speed * AREA_M2 / expected - 1.0).abs() < 0.03, "{speed}");
        }
        assert!(speed_m_s(2000.0, [0.0, 0.9]) < 1.4 * speed_m_s(400.0, [0.0, 0.9]));
        // Without currents it sinks by its leakage.
        assert!((-1e-3..-1e-5).contains(&speed_m_s(2000.0, [0.0, 0.0])));
    }
}
