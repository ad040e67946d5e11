//! What the page gets of a session, as JSON. The declarations for its scripts, `web/views.d.ts`, are generated from these types.
pub mod added;
pub mod candidate;
pub mod effect_texts;
pub mod explained;
pub mod fitted;
pub mod message;
pub mod next_experiment;
pub mod ranking;
pub mod run;
pub mod second;
pub mod state;
pub mod trial;
pub mod tuned;
pub mod way;
