//! Measuring and calibrating over XCP.

mod calibrating;
mod client;
mod connection;
mod measuring;
mod nonsense;
