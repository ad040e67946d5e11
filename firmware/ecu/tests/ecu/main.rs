//! The whole application: converter codes, contacts and frames in, pulse widths and frames out.

mod bench;
mod bus_watch;
mod button;
mod engine;
mod field;
mod history;
mod key;
mod remote;
mod start_check;
