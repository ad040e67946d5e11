//! Tests of the plant, the effects and the identification.

mod adopted_machines;
mod base_fit;
mod baseline;
mod changes;
mod coarse_simulation;
mod convergence;
mod coverage;
mod declared_constants;
mod drawn_campaigns;
mod estimation;
mod hidden_effects;
mod independent_plant;
mod known_campaigns;
mod mixed_rates;
mod next_experiment;
mod odd_campaigns;
mod own_terms;
mod paper;
mod parameters;
mod synchronous_clocks;
mod wrong_base;
