//! The interactive page of `hitch serve`: a web server on 127.0.0.1 and what it shows.
//!
//! The browser draws; every number is computed here. Each tab has its own `session::Session`. Long computations run as
//! jobs, and the tab follows their progress through Server-Sent Events.
#![forbid(unsafe_code)]

mod assets;
#[cfg(test)]
mod declarations;
mod fault;
mod first;
mod first_table;
mod guard;
mod jobs;
mod live;
mod next_routes;
mod own_term;
mod parameters;
mod refusal;
mod request;
mod routes;
mod saving;
mod second;
mod second_routes;
mod server;
mod session;
mod sessions;
mod source;
mod tasks;
mod tuned;
mod upload;
mod views;

pub use assets::page_text;
pub use live::LoopSource;
pub use server::run;
pub use source::Source;
