//! `bulk-modulus`: deviation of the oil's bulk modulus from the declared value.
//!
//! `E = (1 + change) E_declared`. Mineral oil in steel has 1.4 to 1.8e9 Pa; the effective value with line and cylinder
//! wall is 0.7 to 1.4e9 Pa (Jelali & Kroll 3.2). A declared value is often off by a third. Unlike the compliance of a
//! hose, which is independent of the piston position, it scales with the whole volume of oil; it does not depend on the
//! pressure.

use hitch_plant::{Channel, Dynamics, Parameter};

use crate::described::Described;

/// Deviation of the bulk modulus.
pub static BULK_MODULUS: Described = Described {
    id: "bulk-modulus",
    title: "Deviation of the bulk modulus of the oil",
    equation: "E = (1 + change) E_declared",
    source: "Jelali & Kroll 3.2: 0.7 to 1.8e9 Pa with line and cylinder wall",
    shows: "slower or faster ringing of the cylinder pressure, the more the further the cylinder is out; hoses take up \
         the same volume anywhere",
    parameters: &[Parameter {
        meaning: "change of the modulus as a share of the declared one",
        typical: -0.3,
        low: -0.8,
        high: 1.0,
        ..Parameter::ratio("change")
    }],
    channels: &[Channel::CylinderPressure],
    needs: Some(Dynamics::Dynamic),
    attach: |values, _, hooks| {
        let factor = 1.0 + values[0];
        hooks.stiffness_factor.push(Box::new(move |_| factor));
    },
    ..Described::USUAL
};
