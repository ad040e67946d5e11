//! Files that are opened in the page: received into a temporary folder, surveyed, assigned and read as by `hitch import`.
//!
//! A tab has one upload at a time, independent of other tabs. Its folder is deleted when the campaign is open, when
//! another upload begins, with the session, after [`limits::LIFETIME`], and at the latest when the server stops.
mod assignment;
mod folder;
mod incoming;
mod limits;
mod proposal;
mod routes;
pub mod surveyed;

pub use folder::{Folders, Upload};
pub use routes::routes;
