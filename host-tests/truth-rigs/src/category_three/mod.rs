//! A larger hitch than the paper's, with its data sheets and the files of its two loggers: the machine of
//! docs/your-own-hitch.md.
//!
//! Category III: two cylinders of 90 mm, a load-sensing pump, valves that end at 1.6 A, a linkage that is known as a
//! table. The equations are written for this machine only and share no code with `model/plant`; only `compressed_mdf`
//! and the German table are formats that the project reads.
//!
//! ```text
//! machine          data sheet values, and what is different on the machine
//! motion           equations of motion, integrated in steps of 0.25 ms
//! working_day      moves of an operator, sampled by instruments
//! compressed_mdf   a log as MDF 4.1 with deflated data
//! files            data sheets and logs as files
//! ```

pub mod compressed_mdf;
pub mod files;
pub mod machine;
pub mod motion;
pub mod working_day;
