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
use super::nominal::{LIFT, LINKAGE, LOWER};
use super::parameter::{Group, ParameterGroup};
use super::valve_table::ValveTable;
use crate::units::{MicroLitrePerSecond, MilliAmp};

/// Layout of the block that this firmware reads.
pub const CALIBRATION_VERSION: u32 = 10;

/// Largest flow in a table: ten times the pump's, and far from where products saturate.
pub(super) const FLOW_LIMIT: MicroLitrePerSecond = MicroLitrePerSecond(10_000_000);

pub(super) const CURRENT_LIMIT: MilliAmp = MilliAmp(5_000);

/// Declares the block by its groups of scalars, in their order behind the tables.
macro_rules! calibration {
    ($($(#[$doc:meta])+ $group:ident: $Group:ident,)+) => {
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
            $($(#[$doc])+ pub $group: $Group,)+
            /// CRC-32 (ISO-HDLC) over everything before it, words in little-endian order.
            pub checksum: u32,
        }

        /// The groups in the order of the block.
        pub const GROUPS: [Group; [$(<$Group as ParameterGroup>::NAME),+].len()] = [$(Group::of::<$Group>()),+];

        impl Calibration {
            /// The calibration of an untaught machine without a checksum, to be filled with something else. Not inlined: the
            /// block would take its place on the stack of every caller.
            #[inline(never)]
            pub(crate) fn unsealed_nominal() -> Self {
                Self {
                    version: CALIBRATION_VERSION,
                    lift: LIFT,
                    lower: LOWER,
                    linkage: LINKAGE,
                    $($group: $Group::NOMINAL,)+
                    checksum: 0,
                }
            }

            /// Scalar `index`, counted through all groups.
            pub(super) fn scalar(&self, index: usize) -> Option<i32> {
                // The first group that has it ends the search.
                let at = &mut { index };
                None$(.or_else(|| scalar_of(&self.$group, at)))+
            }

            /// Visits every scalar in the order of the block.
            #[inline]
            pub(super) fn visit_scalars(&mut self, visit: &mut dyn FnMut(&mut i32)) {
                $(self.$group.visit(visit);)+
            }
        }
    };
}

/// Scalar `index` of a group; otherwise the index counts from its end on.
fn scalar_of<G: ParameterGroup>(group: &G, index: &mut usize) -> Option<i32> {
    let found = group.get(*index);
    *index = index.wrapping_sub(G::INFO.len());
    found
}

calibration! {
    /// Hydraulic circuit.
    hydraulics: HydraulicParameters,
    /// Plausibility of sensors.
    sensors: SensorParameters,
    /// Start-up lock.
    lock: LockParameters,
    /// What the operator sets besides the lever.
    operator: OperatorParameters,
    /// Motion estimator.
    motion: MotionParameters,
    /// Position control.
    position: PositionParameters,
    /// Rate control.
    rate: RateParameters,
    /// Check-valve logic.
    hold: HoldParameters,
    /// Compensator logic.
    saturation: SaturationParameters,
    /// Teaching.
    teach: TeachParameters,
    /// Regulation of the coils' currents.
    current: CurrentParameters,
    /// What is sent on the bus, and from whom it is received.
    bus: BusParameters,
    /// Remote control by an implement.
    remote: RemoteParameters,
    /// Draft pins and draft control.
    draft: DraftParameters,
    /// External depth sensor and depth control.
    depth: DepthParameters,
    /// Slip guard.
    slip: SlipParameters,
    /// Ride damping.
    ride: RideParameters,
    /// When the implement is in work.
    work: WorkParameters,
    /// Safety envelope.
    safety: SafetyParameters,
}

/// Size of the block in bytes.
pub const CALIBRATION_BYTES: usize = size_of::<Calibration>();
