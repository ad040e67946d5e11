//! `hitch`: measurement -> physics -> firmware -> motion.
fn main() {}
