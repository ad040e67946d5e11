//! Where the hitch is, how fast it goes, what it carries, and how its spools and its load behave on the way.

pub mod course;
pub mod damping;
pub mod free_fall;
pub mod lag;
pub mod late;
pub mod load;
pub mod motion;
pub mod outrun;
pub mod rest;
pub mod swing;
