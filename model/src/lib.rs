//! The plant of an electro-hydraulic three-point hitch, its effects, measurements and identification.
#![forbid(unsafe_code)]
