//! The hydraulic circuit at one instant: which flows and which pump pressure go with a cylinder pressure.

use super::sites::Sites;
use crate::model::Constants;

/// How far the two valves are open, as their flow at the reference drop, m3/s.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Openings {
    /// Lift valve.
    pub lift_m3_s: f64,
    /// Lowering valve.
    pub lower_m3_s: f64,
}

/// Flows and pump pressure of the circuit.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Flows {
    /// Through the lift valve into the cylinder, m3/s.
    pub lift_m3_s: f64,
    /// Through the lowering valve to tank, m3/s.
    pub lower_m3_s: f64,
    /// Out of the cylinder past the valves, m3/s.
    pub leakage_m3_s: f64,
    /// Pump pressure, Pa.
    pub pump_pressure_pa: f64,
}

impl Flows {
    /// What the flow meter in the cylinder line sees, m3/s, positive into the cylinder.
    #[must_use]
    pub fn metered_m3_s(&self) -> f64 {
        self.lift_m3_s - self.lower_m3_s
    }

    /// What the oil in the cylinder gains, m3/s.
    #[must_use]
    pub fn net_m3_s(&self) -> f64 {
        self.metered_m3_s() - self.leakage_m3_s
    }
}

/// The circuit between pump, tank and cylinder port.
pub struct Circuit<'a> {
    /// The components.
    pub constants: &'a Constants,
    /// What the effects attach to them.
    pub sites: &'a Sites,
}

impl Circuit<'_> {
    /// Opens the valves as far as effective currents, A, tell.
    #[must_use]
    pub fn openings(&self, lift_a: f64, lower_a: f64) -> Openings {
        Openings {
            lift_m3_s: self.constants.lift_valve.curve.flow_m3_s(lift_a)
                * self.sites.lift_flow_factor,
            lower_m3_s: self.constants.lower_valve.curve.flow_m3_s(lower_a)
                * self.sites.lower_flow_factor,
        }
    }

    /// Solves the circuit for a cylinder pressure, Pa.
    #[must_use]
    pub fn solve(&self, openings: Openings, cylinder_pressure_pa: f64) -> Flows {
        let (lift_m3_s, pump_pressure_pa) = self.lift(openings.lift_m3_s, cylinder_pressure_pa);
        Flows {
            lift_m3_s,
            lower_m3_s: self.lower_m3_s(openings.lower_m3_s, cylinder_pressure_pa),
            leakage_m3_s: self.sites.leakage_m3_s(cylinder_pressure_pa),
            pump_pressure_pa,
        }
    }

    /// Lift flow, m3/s, and pump pressure, Pa.
    fn lift(&self, opening_m3_s: f64, cylinder_pressure_pa: f64) -> (f64, f64) {
        let constants = self.constants;
        if opening_m3_s <= 0.0 {
            return (0.0, constants.compensator.idle_pressure_pa());
        }
        let wanted_pa = constants
            .compensator
            .lifting_pressure_pa(cylinder_pressure_pa);
        let pump_pressure_pa = constants.relief_valve.limit_pa(wanted_pa);
        let drop_pa = constants
            .check_valve
            .remaining_drop_pa(pump_pressure_pa, cylinder_pressure_pa);
        let flow_m3_s = constants.lift_valve.flow_m3_s(opening_m3_s, drop_pa);
        let available_m3_s = constants.pump.flow_m3_s();
        if flow_m3_s <= available_m3_s {
            return (flow_m3_s, pump_pressure_pa);
        }
        // The compensator is shut and still short of its margin: the pump's whole flow sets the drop (equation 5).
        let ratio = available_m3_s / flow_m3_s;
        let short_pa = drop_pa * (1.0 - ratio * ratio);
        (available_m3_s, pump_pressure_pa - short_pa)
    }

    /// Lowering flow, m3/s: the valve's drop is what the return line leaves.
    fn lower_m3_s(&self, opening_m3_s: f64, cylinder_pressure_pa: f64) -> f64 {
        if opening_m3_s <= 0.0 {
            return 0.0;
        }
        let valve = &self.constants.lower_valve;
        let free_m3_s = valve.flow_m3_s(opening_m3_s, cylinder_pressure_pa);
        if self.sites.return_pressure.is_empty() || free_m3_s == 0.0 {
            return free_m3_s;
        }
        // Root of f(Q) = Q - valve(p - p_T(Q)): it rises in Q, and lies between no flow and the free flow.
        let excess = |flow_m3_s: f64| {
            let drop_pa = cylinder_pressure_pa - self.sites.return_pressure_pa(flow_m3_s);
            flow_m3_s - valve.flow_m3_s(opening_m3_s, drop_pa)
        };
        crate::plant::root::rising(excess, 0.0, free_m3_s, free_m3_s * 1e-7)
    }
}
