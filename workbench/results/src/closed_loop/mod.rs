//! Moves, buttons and figures of the firmware's controller in closed loop with a plant.

mod ideal_ramp;
mod metrics;
mod missed;
mod moves;
mod pressure_swing;
mod rate;
pub mod rebuild;
mod scenario;
mod scenario_figure;
pub mod show;
pub mod show_variants;
pub mod variant;

pub use ideal_ramp::IdealRamp;
pub use metrics::{MoveResult, Summary};
pub use missed::first_missed;
pub use moves::{Course, LoopRun, MoveTrace, courses, figures, run, run_quick_lift};
pub use rate::{Press, PressResult, PressRun, PressSummary, PressTrace, presses, run_presses};
pub use scenario::{Move, OIL_TEMPERATURE_C, Scenario};
pub use scenario_figure::ScenarioFigure;
