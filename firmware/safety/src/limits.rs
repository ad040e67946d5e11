//! What the envelope goes by: its limits, and what currents do to the machine.

use hitch_quantities::calibration::design_parameters::{
    HydraulicParameters, LockParameters, OperatorParameters, RateParameters, RemoteParameters,
    SafetyParameters, SensorParameters,
};
use hitch_quantities::calibration::field_parameters::RideParameters;
use hitch_quantities::calibration::linkage::LinkageTable;
use hitch_quantities::calibration::valve_table::ValveTable;
use hitch_quantities::piston::{flow, piston_speed};
use hitch_quantities::units::{MicrometrePerSecond, MilliAmp, MilliDegree};
use hitch_quantities::{Calibration, CoilCurrents};

/// What the envelope goes by.
#[derive(Clone, Copy, Debug)]
pub struct Limits<'a> {
    /// Its own limits.
    pub safety: &'a SafetyParameters,
    /// What sensors can plausibly say.
    pub sensors: &'a SensorParameters,
    /// When the engine locks the hitch, and how long no row may have held before a reset.
    pub lock: &'a LockParameters,
    /// Where the dials are shut, and the contacts of the buttons.
    pub operator: &'a OperatorParameters,
    /// How far a button moves the hitch.
    pub rate: &'a RateParameters,
    /// How the operator consents to remote control.
    pub remote: &'a RemoteParameters,
    /// What ride damping keeps to.
    pub ride: &'a RideParameters,
    /// They, or others of their calibration, have changed in memory.
    pub damaged: bool,
    /// What currents do to the hitch.
    pub machine: MachineModel<'a>,
}

/// Model of the machine for the monitor.
#[derive(Clone, Copy, Debug)]
pub struct MachineModel<'a> {
    /// Lift valve.
    lift: &'a ValveTable,
    /// Lowering valve.
    lower: &'a ValveTable,
    /// Rocker angle to piston travel.
    pub(crate) linkage: &'a LinkageTable,
    /// Hydraulic circuit.
    pub(crate) hydraulics: &'a HydraulicParameters,
    /// Lowest and highest set point, just inside the ends of the travel.
    ends: (MilliDegree, MilliDegree),
}

impl<'a> MachineModel<'a> {
    /// The machine of a calibration.
    #[must_use]
    pub const fn of(calibration: &'a Calibration) -> Self {
        Self {
            lift: &calibration.lift,
            lower: &calibration.lower,
            linkage: &calibration.linkage,
            hydraulics: &calibration.hydraulics,
            ends: (
                calibration.position.lower_limit,
                calibration.position.upper_limit,
            ),
        }
    }

    /// Lowest and highest set point.
    pub(crate) const fn ends(self) -> (MilliDegree, MilliDegree) {
        self.ends
    }

    /// Piston speed that the currents less a margin give.
    pub(crate) fn speed(self, passed: CoilCurrents, margin: MilliAmp) -> MicrometrePerSecond {
        let (table, current) = if passed.lift > MilliAmp::ZERO {
            (self.lift, passed.lift)
        } else {
            (self.lower, passed.lower)
        };
        piston_speed(table.flow(current - margin), self.hydraulics.piston_area)
    }

    /// Signed piston speed that the currents give by the valve curves, upwards.
    pub(crate) fn signed_speed(self, passed: CoilCurrents) -> MicrometrePerSecond {
        let speed = self.speed(passed, MilliAmp::ZERO);
        if passed.lift > MilliAmp::ZERO {
            speed
        } else {
            -speed
        }
    }

    /// Rocker angle for a piston travel of a millimetre at an angle, in thousandths of a degree.
    pub(crate) fn degrees(self, angle: MilliDegree) -> i32 {
        let half = MilliDegree(1_000);
        let way = self.linkage.travel(angle + half) - self.linkage.travel(angle - half);
        2_000_000 / way.0.max(1)
    }

    /// The currents that give a piston speed by the valve curves.
    pub(crate) fn currents(self, speed: [MicrometrePerSecond; 2]) -> CoilCurrents {
        let [lift, lower] = speed.map(|speed| flow(speed, self.hydraulics.piston_area));
        CoilCurrents {
            lift: self.lift.current(lift),
            lower: self.lower.current(lower),
        }
    }
}
