//! Measuring and calibrating over XCP.

mod calibrating;
mod client;
mod connection;
mod key;
mod measuring;
mod nonsense;
