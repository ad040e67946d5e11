//! Plant, coils, instruments and controller of one hitch.

mod arrival;
mod coil;
mod driven_plant;
mod instruments;
mod loop_;
mod with_dynamics;

pub use arrival::ARRIVED_DEG;
pub use coil::Coil;
pub use driven_plant::{DrivenPlant, STEP_S};
pub use instruments::{Instruments, SUPPLY_V};
pub use loop_::{ClosedLoop, Sample};
pub use with_dynamics::with_dynamics;
