//! The calibration as it lies in memory; nothing of it is checked.

use super::design_parameters::{
    BusParameters, CurrentParameters, HoldParameters, HydraulicParameters, LockParameters,
    MotionParameters, OperatorParameters, PositionParameters, RateParameters, RemoteParameters,
    SafetyParameters, SaturationParameters, SensorParameters, TeachParameters,
};
use super::field_parameters::{
    DepthParameters, DraftParameters, RideParameters, SlipParameters, WorkParameters,
};
use super::linkage::LinkageTable;
use super::valve_table::ValveTable;
use crate::units::{MicroLitrePerSecond, MilliAmp};

/// Layout of the block that this firmware reads.
pub const CALIBRATION_VERSION: u32 = 10;

/// Largest flow in a table: ten times the pump's, and far from where products saturate.
pub(super) const FLOW_LIMIT: MicroLitrePerSecond = MicroLitrePerSecond(10_000_000);

pub(super) const CURRENT_LIMIT: MilliAmp = MilliAmp(5_000);

/// The raw block. All of it is 32-bit words, so its memory image has no padding.
#[derive(Clone, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct Calibration {
    /// Layout; see [`CALIBRATION_VERSION`].
    pub version: u32,
    /// Lift valve at the compensated drop.
    pub lift: ValveTable,
    /// Lowering valve at [`HydraulicParameters::reference_drop`].
    pub lower: ValveTable,
    /// Rocker angle to piston travel.
    pub linkage: LinkageTable,
    /// Hydraulic circuit.
    pub hydraulics: HydraulicParameters,
    /// Plausibility of sensors.
    pub sensors: SensorParameters,
    /// Start-up lock.
    pub lock: LockParameters,
    /// What the operator sets besides the lever.
    pub operator: OperatorParameters,
    /// Motion estimator.
    pub motion: MotionParameters,
    /// Position control.
    pub position: PositionParameters,
    /// Rate control.
    pub rate: RateParameters,
    /// Check-valve logic.
    pub hold: HoldParameters,
    /// Compensator logic.
    pub saturation: SaturationParameters,
    /// Teaching.
    pub teach: TeachParameters,
    /// Regulation of the coils' currents.
    pub current: CurrentParameters,
    /// What is sent on the bus, and from whom it is received.
    pub bus: BusParameters,
    /// Remote control by an implement.
    pub remote: RemoteParameters,
    /// Draft pins and draft control.
    pub draft: DraftParameters,
    /// External depth sensor and depth control.
    pub depth: DepthParameters,
    /// Slip guard.
    pub slip: SlipParameters,
    /// Ride damping.
    pub ride: RideParameters,
    /// When the implement is in work.
    pub work: WorkParameters,
    /// Safety envelope.
    pub safety: SafetyParameters,
    /// CRC-32 (ISO-HDLC) over everything before it, words in little-endian order.
    pub checksum: u32,
}

/// Size of the block in bytes.
pub const CALIBRATION_BYTES: usize = size_of::<Calibration>();
