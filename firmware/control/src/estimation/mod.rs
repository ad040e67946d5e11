//! State estimation: position, speed, load, and the dynamics of valves and load during a move.

pub mod compensator_oscillation;
pub mod damping;
pub mod delayed_output;
pub mod free_fall;
pub mod hysteresis_compensation;
pub mod load;
pub mod millisecond_q3;
pub mod motion_observer;
pub mod move_record;
pub mod peak_velocity_ratio;
pub mod rest;
pub mod spool;
pub mod spool_lag;
pub mod stop_prediction;
pub mod travel_distances;
pub mod valve_closing_delay;
