//! Every constant of the plant.

use crate::components::check_valve::CheckValve;
use crate::components::compensator::Compensator;
use crate::components::cylinder::Cylinder;
use crate::components::linkage::LinkageDimensions;
use crate::components::linkage_table::LinkageTable;
use crate::components::load::Masses;
use crate::components::oil::Oil;
use crate::components::orifice_valve::OrificeValve;
use crate::components::pump::Pump;
use crate::components::relief_valve::ReliefValve;
use crate::components::sensor_noise::SensorNoise;
use crate::components::solenoid::Solenoid;
use crate::components::usual_loads::UsualLoads;

/// The two kinds of models (docs/plant.md).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Dynamics {
    /// Quasi-static: no inertia, stiff oil, spools without lag.
    Steady,
    /// With compressibility, inertia, viscous friction and spool lag.
    Dynamic,
}

/// Every constant of the plant, SI.
#[derive(Debug, Clone, PartialEq)]
pub struct Constants {
    /// Steady or dynamic.
    pub dynamics: Dynamics,
    /// The pump.
    pub pump: Pump,
    /// The relief valve at the pump.
    pub relief_valve: ReliefValve,
    /// The pressure compensator.
    pub compensator: Compensator,
    /// The check valve.
    pub check_valve: CheckValve,
    /// The lift valve.
    pub lift_valve: OrificeValve,
    /// The lowering valve.
    pub lower_valve: OrificeValve,
    /// The solenoid of either valve.
    pub solenoid: Solenoid,
    /// First-order lag of either spool, s; used by the dynamic plant.
    pub spool_time_constant_s: f64,
    /// The cylinder.
    pub cylinder: Cylinder,
    /// The oil.
    pub oil: Oil,
    /// The linkage; zero if it is measured.
    pub linkage: LinkageDimensions,
    /// The measured linkage, which replaces the dimensions.
    pub linkage_table: Option<LinkageTable>,
    /// The moving masses without the load.
    pub masses: Masses,
    /// The usual loads.
    pub usual_loads: UsualLoads,
    /// The noise of the sensors.
    pub sensor_noise: SensorNoise,
}
