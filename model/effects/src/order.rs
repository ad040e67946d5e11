//! The order in which effects act.

/// The id of every effect, from the coil to the instruments: where several act at one place, they act in this order.
const IDS: [&str; 31] = [
    "lift-threshold-shift",
    "lower-threshold-shift",
    "lift-flow-scale",
    "lower-flow-scale",
    "solenoid-hysteresis",
    "spool-stiction",
    "spool-lag",
    "flow-force",
    "oil-viscosity",
    "compensator-droop",
    "compensator-margin",
    "check-valve-loss",
    "pump-leakage",
    "pump-flow",
    "relief-override",
    "return-line-loss",
    "lowering-leakage",
    "entrained-air",
    "bulk-modulus",
    "hose-compliance",
    "coulomb-friction",
    "stribeck-friction",
    "viscous-friction",
    "pin-friction",
    "pin-backlash",
    "load-inertia",
    "load-arm",
    "ground-contact",
    "angle-sensor-gain",
    "angle-sensor-lag",
    "pressure-sensor-offset",
];

/// Place of an effect in this order; one that is not in it comes last.
pub(crate) fn rank(id: &str) -> usize {
    IDS.iter()
        .position(|known| *known == id)
        .unwrap_or(IDS.len())
}
