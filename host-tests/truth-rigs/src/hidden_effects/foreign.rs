//! Changes of a machine that differs from its data sheet in many small ways. The model is adopted from a first
//! campaign; the identification answers for a second one.

use std::time::Instant;

use hitch_identification::data::experiment::Experiment;
use hitch_identification::data::problem::Problem;
use hitch_identification::explanation::explain::{explain_with, fit_base};
use hitch_identification::search::options::{Accuracy, Options};
use hitch_plant::{Constants, Model};
use rand::SeedableRng;
use rand_pcg::Pcg64;

use super::explaining;
use super::grade::{Graded, Posed};
use super::starting_point;
use super::wrong_base::put_off;
use crate::second_rig::campaign_writer::campaign;
use crate::second_rig::foreign::{Foreign, draw_foreign};
use crate::second_rig::manoeuvres::Plan;
use crate::second_rig::test_stand::Family;

/// One sigma by which a data sheet's pressures, flows and masses are off, as a share.
const DATA_SHEET: f64 = 0.03;

/// The same for properties that a data sheet does not state: oil, friction, volumes, lags.
const TEXT_BOOK: f64 = 0.1;

/// Streams of random numbers that are apart from those of the machines.
const STREAM: u64 = 0x0000_6461_7461_7368;

/// A machine with the model that was adopted for it.
#[derive(Debug, Clone)]
pub struct Adopted {
    /// The machine.
    pub foreign: Foreign,
    /// The model, with the effects identified in the first campaign.
    pub model: Model,
    /// Error that the model leaves in the first campaign, in sigmas.
    pub error: f64,
    /// How long it took to adopt, s.
    pub seconds: f64,
    /// The second campaign with its measure of difficulty.
    pub posed: Posed,
}

impl Adopted {
    /// Draws a machine and adopts a model for it as `hitch adopt` does.
    #[must_use]
    pub fn new(seed: u64, family: Family, plan: Plan) -> Self {
        let foreign = draw_foreign(seed, family, plan);
        let data_sheet = data_sheet(family, seed);
        let start = Instant::now();
        let first = campaign(&foreign.first);
        let experiment = Experiment::new(&first, &data_sheet);
        let options = Options {
            constants: Accuracy::DataSheet,
            ..Options::default()
        };
        let problem = Problem::new(&experiment, &data_sheet);
        let explanation = explain_with(problem, options, &|_| {});
        let seconds = start.elapsed().as_secs_f64();
        Self {
            model: explanation.after.estimate.applied_to(&data_sheet),
            error: explanation.after.error(),
            seconds,
            posed: Posed::new(foreign.second.clone()),
            foreign,
        }
    }

    /// Lets the identification find the changes.
    #[must_use]
    pub fn ask(&self) -> Graded {
        let (first, second) = (campaign(&self.foreign.first), campaign(&self.posed.case));
        let answer = || explaining::answer_since(&first, &second, &self.model);
        self.posed.answered(answer)
    }

    /// Error that a model leaves in the third campaign, in sigmas.
    #[must_use]
    pub fn error_elsewhere(&self, model: &Model) -> f64 {
        let third = campaign(&self.foreign.third);
        let experiment = Experiment::new(&third, model);
        fit_base(Problem::new(&experiment, model)).error()
    }
}

/// The model of a data sheet that is off from the machine's truth in every constant.
fn data_sheet(family: Family, seed: u64) -> Model {
    let nominal = starting_point(family);
    let mut random = Pcg64::seed_from_u64(seed ^ STREAM);
    let mut constants = nominal.constants().clone();
    spoil(&mut constants, &mut random);
    Model::new("data sheet", constants).expect("the linkage is the nominal one")
}

/// Puts every constant off by some percent.
fn spoil(constants: &mut Constants, random: &mut Pcg64) {
    let constants = [
        (&mut constants.pump.theoretical_flow_m3_s, DATA_SHEET),
        (&mut constants.relief_valve.set_pressure_pa, DATA_SHEET),
        (&mut constants.compensator.margin_pa, DATA_SHEET),
        (&mut constants.check_valve.cracking_pressure_pa, DATA_SHEET),
        (&mut constants.lift_valve.reference_drop_pa, DATA_SHEET),
        (&mut constants.lower_valve.reference_drop_pa, DATA_SHEET),
        (&mut constants.masses.dead_weight_kg, DATA_SHEET),
        (&mut constants.spool_time_constant_s, TEXT_BOOK),
        (&mut constants.cylinder.dead_volume_m3, TEXT_BOOK),
        (&mut constants.cylinder.viscous_friction_n_s_m, TEXT_BOOK),
        (&mut constants.oil.bulk_modulus_pa, TEXT_BOOK),
        (&mut constants.masses.piston_kg, TEXT_BOOK),
    ];
    put_off(constants, random);
}
