//! Tests of the controller in closed loop with a plant.

mod beyond;
mod closed_loop;
mod current;
mod depth;
mod draft;
mod drawn_hitches;
mod drifting_reference;
mod engage;
mod extra_travel;
mod flooded_bus;
mod from_measurement_to_motion;
mod frozen_angle;
mod identified_dynamics;
mod in_work;
mod other_linkage;
mod position;
mod power_cut;
mod rate;
mod ride;
mod sensor_lag;
mod start_up;
mod teach;
mod traces;
mod wide_hysteresis;
mod wrong_calibration;
