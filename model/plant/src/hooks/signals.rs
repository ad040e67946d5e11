//! The signals that user-defined terms may depend on: the state of the plant at one instant, by name.

/// The state of the plant at one instant, SI.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Signals {
    /// Piston travel from the lower end, m.
    pub travel_m: f64,
    /// Piston speed, positive while lifting, m/s.
    pub speed_m_s: f64,
    /// Rocker angle, rad.
    pub rocker_angle_rad: f64,
    /// Pressure at the cylinder, Pa.
    pub cylinder_pressure_pa: f64,
    /// Pressure at the pump, Pa.
    pub pump_pressure_pa: f64,
    /// Effective current of the lift spool, A.
    pub lift_current_a: f64,
    /// Effective current of the lowering spool, A.
    pub lower_current_a: f64,
    /// Flow through the lift valve, m3/s.
    pub lift_flow_m3_s: f64,
    /// Flow through the lowering valve, m3/s.
    pub lower_flow_m3_s: f64,
    /// Load at the hitch point, kg.
    pub load_kg: f64,
    /// Force of load and dead weight at the piston, N.
    pub weight_n: f64,
    /// Oil temperature, degree Celsius.
    pub oil_temperature_c: f64,
    /// Kinematic viscosity of the oil, m2/s.
    pub viscosity_m2_s: f64,
}

/// A signal as named in formulas, documents and messages.
#[derive(Debug)]
pub struct Signal {
    /// Name in a formula.
    pub name: &'static str,
    /// Its SI unit; a temperature is in degree Celsius.
    pub unit: &'static str,
    /// The unit in which logs and data sheets state such values; a number beside the signal is meant in it.
    pub written_unit: &'static str,
    /// Description.
    pub meaning: &'static str,
    /// Smallest value that occurs on a rig, SI.
    pub low: f64,
    /// Largest value that occurs on a rig, SI.
    pub high: f64,
    /// Accessor of its field.
    pub place: fn(&mut Signals) -> &mut f64,
    /// Its value.
    pub value: fn(&Signals) -> f64,
}

macro_rules! signal {
    ($name:literal, $unit:literal, $written:literal, $low:literal..=$high:literal, $field:ident, $meaning:literal) => {
        Signal {
            name: $name,
            unit: $unit,
            written_unit: $written,
            meaning: $meaning,
            low: $low,
            high: $high,
            place: |signals| &mut signals.$field,
            value: |signals| signals.$field,
        }
    };
}

/// Every signal.
#[rustfmt::skip]
pub static SIGNALS: [Signal; 13] = [
    signal!("x", "m", "mm", 0.0..=0.158, travel_m, "piston travel from the lower end"),
    signal!("v", "m/s", "mm/s", -0.3..=0.3, speed_m_s, "piston speed, positive while lifting"),
    signal!("rocker_angle", "rad", "deg", 0.7..=2.4, rocker_angle_rad, "angle of the rocker arm, a quarter turn where it points straight down"),
    signal!("p_cyl", "Pa", "bar", 0.0..=200e5, cylinder_pressure_pa, "pressure at the cylinder"),
    signal!("p_pump", "Pa", "bar", 0.0..=200e5, pump_pressure_pa, "pressure at the pump"),
    signal!("i_lift", "A", "A", 0.0..=3.5, lift_current_a, "effective current of the lift spool"),
    signal!("i_lower", "A", "A", 0.0..=3.5, lower_current_a, "effective current of the lowering spool"),
    signal!("q_lift", "m3/s", "l/min", 0.0..=1.2e-3, lift_flow_m3_s, "flow through the lift valve"),
    signal!("q_lower", "m3/s", "l/min", 0.0..=1.2e-3, lower_flow_m3_s, "flow through the lowering valve"),
    signal!("load", "kg", "kg", 0.0..=500.0, load_kg, "load at the hitch point, without the dead weight"),
    signal!("f_weight", "N", "kN", 0.0..=3e4, weight_n, "force of load and dead weight at the piston"),
    signal!("t_oil", "degC", "degC", -20.0..=100.0, oil_temperature_c, "oil temperature, counted from 0 degree Celsius"),
    signal!("nu", "m2/s", "cSt", 5e-6..=1e-3, viscosity_m2_s, "kinematic viscosity of the oil"),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_signal_is_read_where_it_is_written() {
        let mut signals = Signals::default();
        for (number, signal) in (1..).zip(&SIGNALS) {
            *(signal.place)(&mut signals) = f64::from(number);
        }
        for (number, signal) in (1..).zip(&SIGNALS) {
            assert_eq!(
                (signal.value)(&signals),
                f64::from(number),
                "{}",
                signal.name
            );
        }
    }
}
