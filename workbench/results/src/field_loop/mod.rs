//! Passes of the tractor over fields and roads, with the hitch and its controller: `hitch_closed_loop::field`.

pub mod figures;
pub mod pass;
pub mod scenario;
pub mod show;
pub mod transport;
pub mod undulation;
