//! Machines that share no equation with the model, and the campaigns and moves that they give: the truth that the tests
//! compare with.
//!
//! * [`second_rig`]: a hitch on a test stand with its own equations and integrator; it hides effects, and can be foreign;
//! * [`category_three`]: a larger hitch with a load-sensing pump;
//! * [`drawn_hitches`]: machines with random constants in closed loop, and [`frozen_angle`]: with a frozen angle sensor;
//! * [`hidden_effects`]: what the identification makes of drawn campaigns.

pub mod category_three;
pub mod drawn_hitches;
pub mod frozen_angle;
pub mod hidden_effects;
pub mod lab;
pub mod polyline;
pub mod second_rig;
pub mod simulated_lab;
