//! Two hitches that follow the orders of the user of a page.
//!
//! Their plant is the present model; the calibration of the first is built from the initial model, that of the second
//! from the present one. With a field in the orders, each works behind a tractor on its own pass over the same soil.

mod description;
mod field_orders;
mod field_view;
mod figures;
mod hitch;
mod machine;
mod orders;
mod pair;
mod sensor_fault;
mod strip;
mod words;
mod worked;

pub use description::Described;
pub use field_orders::{FieldOrders, FunctionOrder, GroundOrder, SoilOrder};
pub use field_view::{DrawnGround, FieldNow, FieldView};
pub use figures::MoveFigures;
pub use machine::{Machine, MachineError, Models, NoField, calibration};
pub use orders::{Button, LONGEST_MS, Orders, wrong_advance};
pub use pair::Pair;
pub use sensor_fault::{Kind, Sensor, SensorFault};
pub use strip::{HitchView, Strip};
