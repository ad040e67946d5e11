//! The firmware's controller in closed loop with a plant.

mod arrival;
mod coil;
mod driven_plant;
mod ideal_ramp;
mod instruments;
mod loop_;
mod machine;
mod metrics;
mod missed;
mod moves;
mod rate;
mod scenario;
pub mod show;
pub mod show_variants;
pub mod variant;

pub use arrival::ARRIVED_DEG;
pub use coil::Coil;
pub use driven_plant::DrivenPlant;
pub use ideal_ramp::IdealRamp;
pub use instruments::{Instruments, SUPPLY_V};
pub use loop_::{ClosedLoop, Sample};
pub use machine::with_dynamics;
pub use metrics::{MoveResult, Summary};
pub use missed::first_missed;
pub use moves::{Course, LoopRun, MoveTrace, courses, figures, run, run_quick_lift};
pub use rate::{Press, PressResult, PressRun, PressSummary, PressTrace, presses, run_presses};
pub use scenario::{Move, OIL_TEMPERATURE_C, Scenario};
