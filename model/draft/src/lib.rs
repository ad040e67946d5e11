//! Draft campaigns: runs with an implement at several depths and speeds, and what they say of implement, soil and sensors.
//!
//! ```text
//!   campaign.toml, logs --> blocks of a metre --> whitened by the soil's correlation --> coefficients, with intervals
//!                                                                                    --> hidden effects, by evidence
//! ```
//!
//! The law is that of ASABE D497.5, `D = F (A + B S + C S²) W T`, linear in `F A`, `F B` and `F C`. The strength of the soil
//! varies along each run; how far, and over which length, is estimated. All of this is Gaussian and linear, so that estimates and
//! evidence have closed forms for each length.
//!
//! From the bottom layer to the top: [`machine`] and [`block`]; [`manifest`] and [`log`], which read a folder; [`term`];
//! [`whitening`]; [`evidence`]; [`next_run`]; [`fit`]; [`simulated`], which draws campaigns from the model of the field.
#![forbid(unsafe_code)]

pub mod block;
pub mod evidence;
pub mod fit;
pub mod log;

pub mod machine;
pub mod manifest;

pub mod next_run;
pub mod simulated;
pub mod term;
pub mod whitening;
