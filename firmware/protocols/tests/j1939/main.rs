//! The hitch as a node of J1939 and ISO 11783.

mod bus;
mod claim;
mod consent;
mod diagnostics;
mod engine;
mod facilities;
mod flood;
mod heartbeat;
mod machine_speed;
mod measured;
mod messages;
mod reception;
mod remote;
mod tim;
mod transport;
