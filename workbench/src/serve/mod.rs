//! The interactive page of `hitch serve`: a web server on 127.0.0.1 and what it shows.
//!
//! The browser draws and asks; every number is computed here. A tab has a `session::Session` of its own. What takes
//! longer than a request runs as a job, whose progress the tab follows as Server-Sent Events.
mod assets;
mod guard;
mod jobs;
mod own_term;
mod routes;
mod server;
mod session;
mod sessions;
mod source;
mod tasks;
mod views;

pub use server::run;
pub use source::Source;
