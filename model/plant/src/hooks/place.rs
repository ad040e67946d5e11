//! The places in the plant where a term acts.

use crate::channel::Channel;

/// The place where a term acts. Terms are in SI units.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Place {
    /// Added to the effective current of the lift spool, A.
    LiftCurrent,
    /// Added to the effective current of the lowering spool, A.
    LowerCurrent,
    /// The flow through the lift valve is multiplied by 1 + term.
    LiftFlowFactor,
    /// The flow through the lowering valve is multiplied by 1 + term.
    LowerFlowFactor,
    /// Flow out of the cylinder past the valves, m3/s.
    Leakage,
    /// Force on the piston against positive motion, N.
    Friction,
    /// Added to the force of the weight at the piston, N.
    Weight,
    /// Added to the reading of the cylinder's pressure sensor, Pa.
    CylinderPressureSensor,
    /// Added to the reading of the pump's pressure sensor, Pa.
    PumpPressureSensor,
    /// Added to the reading of the angle sensor, rad.
    AngleSensor,
    /// Added to the reading of the flow sensor, m3/s.
    FlowSensor,
    /// Pressure downstream of the lowering valve, Pa.
    ReturnPressure,
    /// Added to the margin of the pressure compensator, Pa.
    CompensatorMargin,
}

/// Properties of a place.
struct About {
    place: Place,
    id: &'static str,
    unit: &'static str,
    meaning: &'static str,
    channels: &'static [Channel],
}

const MOTION: &[Channel] = &[Channel::Flow, Channel::RockerAngle];
const PUMPED: &[Channel] = &[Channel::PumpPressure, Channel::Flow, Channel::RockerAngle];

/// Every place, in the order of [`Place`].
#[rustfmt::skip]
static ABOUT: [About; 13] = [
    About { place: Place::LiftCurrent, id: "lift-current", unit: "A", channels: PUMPED,
        meaning: "added to the effective current of the lift spool" },
    About { place: Place::LowerCurrent, id: "lower-current", unit: "A", channels: MOTION,
        meaning: "added to the effective current of the lowering spool" },
    About { place: Place::LiftFlowFactor, id: "lift-flow-factor", unit: "1", channels: MOTION,
        meaning: "the flow through the lift valve is multiplied by 1 + term" },
    About { place: Place::LowerFlowFactor, id: "lower-flow-factor", unit: "1", channels: MOTION,
        meaning: "the flow through the lowering valve is multiplied by 1 + term" },
    About { place: Place::Leakage, id: "leakage", unit: "m3/s", channels: &[Channel::RockerAngle],
        meaning: "flow out of the cylinder past the valves" },
    About { place: Place::Friction, id: "friction", unit: "N", channels: &Channel::ALL,
        meaning: "force on the piston against positive motion" },
    About { place: Place::Weight, id: "weight", unit: "N", channels: &Channel::ALL,
        meaning: "added to the force of the weight at the piston" },
    About { place: Place::CylinderPressureSensor, id: "cylinder-pressure-sensor", unit: "Pa",
        channels: &[Channel::CylinderPressure],
        meaning: "added to what the cylinder's pressure sensor shows" },
    About { place: Place::PumpPressureSensor, id: "pump-pressure-sensor", unit: "Pa",
        channels: &[Channel::PumpPressure],
        meaning: "added to what the pump's pressure sensor shows" },
    About { place: Place::AngleSensor, id: "angle-sensor", unit: "rad", channels: &[Channel::RockerAngle],
        meaning: "added to what the angle sensor shows" },
    About { place: Place::FlowSensor, id: "flow-sensor", unit: "m3/s", channels: &[Channel::Flow],
        meaning: "added to what the flow sensor shows" },
    About { place: Place::ReturnPressure, id: "return-pressure", unit: "Pa", channels: MOTION,
        meaning: "pressure behind the lowering valve" },
    About { place: Place::CompensatorMargin, id: "compensator-margin", unit: "Pa", channels: PUMPED,
        meaning: "added to the margin of the pressure compensator" },
];

impl Place {
    /// Every place.
    pub fn all() -> impl Iterator<Item = Self> {
        ABOUT.iter().map(|about| about.place)
    }

    /// The place with this id.
    #[must_use]
    pub fn named(id: &str) -> Option<Self> {
        Self::all().find(|place| place.id() == id)
    }

    /// Its id in a model file.
    #[must_use]
    pub fn id(self) -> &'static str {
        self.about().id
    }

    /// The SI unit of a term at this place.
    #[must_use]
    pub fn unit(self) -> &'static str {
        self.about().unit
    }

    /// Description of the action of a term at this place.
    #[must_use]
    pub fn meaning(self) -> &'static str {
        self.about().meaning
    }

    /// The channels that a term at this place changes directly.
    #[must_use]
    pub fn channels(self) -> &'static [Channel] {
        self.about().channels
    }

    fn about(self) -> &'static About {
        &ABOUT[self as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hitch_input::unit::Unit;

    #[test]
    fn the_table_is_in_order() {
        for (index, place) in Place::all().enumerate() {
            assert_eq!(place as usize, index);
            assert_eq!(Place::named(place.id()), Some(place));
            assert_eq!(Unit::parse(place.unit()).unwrap().si, 1.0, "{}", place.id());
        }
    }
}
