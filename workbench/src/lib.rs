//! Library of the program `hitch`: a command ([`commands`], named in [`cli`]) reads its inputs, has the result computed by
//! `hitch-results`, and shows it as text, JSON, report or page.
#![forbid(unsafe_code)]

pub mod cli;
pub mod commands;
