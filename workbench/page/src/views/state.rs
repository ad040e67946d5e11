//! The state of a tab: campaign, model, steps, error map, and the results that belong to them.

use hitch_identification::data::ready_run::ReadyRun;
use schemars::JsonSchema;
use serde::Serialize;

use super::added::ShownEffect;
use super::explained::ShownExplanation;
use super::fitted::Constants;
use super::ranking::ShownRanking;
use super::second::SecondModel;
use super::tuned::TunedCalibration;
use super::way::WayStep;
use crate::session::{Session, Step};
use hitch_output::text::words::{self, Word};
use hitch_results::comparison::{Cell, Comparison, Evaluated};
use hitch_results::report::map_view::{GroupingTitle, MeasuredChannel};
use hitch_results::report::run_views::conditions;

/// State of a tab.
#[derive(Debug, Serialize, JsonSchema)]
pub struct State {
    /// Name of the campaign.
    pub campaign: String,
    /// What it is about.
    pub description: String,
    /// Name and kind of the first model.
    pub model: String,
    /// Name of the first model before it; `null` if there is none.
    pub earlier_model: Option<String>,
    /// The steps from data to a saved calibration.
    pub way: Vec<WayStep>,
    /// Constants that a fit moves, and their fit.
    pub constants: Constants,
    /// The tuned calibration of the present model.
    pub tuned: Option<TunedCalibration>,
    /// What the terms of results mean.
    pub words: Vec<Word>,
    /// The runs.
    pub runs: Vec<ListedRun>,
    /// The measured channels.
    pub channels: Vec<MeasuredChannel>,
    /// Error of all channels, sigma.
    pub error: f64,
    /// Error of a perfect model, sigma.
    pub noise_floor: f64,
    /// Groupings of the error map.
    pub groupings: Vec<GroupingTitle>,
    /// The second model, compared with the present one.
    pub second: Option<SecondModel>,
    /// The error map.
    pub cells: Vec<Cell>,
    /// All steps, with undone ones.
    pub steps: Vec<ShownStep>,
    /// Index of the present step.
    pub at: usize,
    /// The effects of the present model.
    pub effects: Vec<ShownEffect>,
    /// The ranking, if it belongs to the present model.
    pub ranking: Option<ShownRanking>,
    /// The explanation, if it starts from the present model.
    pub explained: Option<ShownExplanation>,
    /// Title of the running computation.
    pub job: Option<String>,
}

/// A run in the list of runs.
#[derive(Debug, Serialize, JsonSchema)]
pub struct ListedRun {
    /// Its file.
    pub file: String,
    /// Load or port pressure, and oil temperature, as text.
    pub conditions: String,
    /// Its error, sigma; `null` if nothing of it is compared.
    #[schemars(with = "Option<f64>")]
    pub error: f64,
}

/// A step of a session.
#[derive(Debug, Serialize, JsonSchema)]
pub struct ShownStep {
    /// Its title.
    pub title: String,
    /// Error, sigma.
    pub error: f64,
    /// Error on held-out runs, sigma; `null` without a fit.
    pub held_out: Option<f64>,
}

/// A session that has begun.
#[derive(Debug, Serialize, JsonSchema)]
pub struct Begun {
    /// Its id.
    pub session: String,
    /// Its state.
    pub state: State,
}

impl State {
    /// The state of a session.
    pub fn of(session: &Session) -> Self {
        let subject = session.subject();
        let evaluated = &session.present().evaluated;
        let comparison = Comparison::of(evaluated, &subject.model);
        Self {
            campaign: subject.experiment().name.clone(),
            description: subject.description.clone(),
            model: words::named(&subject.model),
            earlier_model: session.earlier().map(str::to_owned),
            way: WayStep::all(session),
            constants: Constants::of(session),
            tuned: session
                .present_tuned()
                .map(|tuned| TunedCalibration::of(tuned)),
            words: words::ALL.to_vec(),
            runs: runs(evaluated),
            channels: MeasuredChannel::all(evaluated),
            error: comparison.error,
            noise_floor: comparison.noise_floor,
            groupings: GroupingTitle::all(),
            second: SecondModel::of(session, &comparison),
            cells: comparison.cells,
            steps: session.steps().iter().map(ShownStep::of).collect(),
            at: session.at(),
            effects: ShownEffect::all(&session.fit().estimate),
            ranking: session
                .present_ranking()
                .map(|ranking| ShownRanking::of(ranking)),
            explained: session
                .present_explanation()
                .map(|explained| ShownExplanation::of(explained)),
            job: session.job.as_ref().map(|job| job.title.clone()),
        }
    }
}

impl ShownStep {
    fn of(step: &Step) -> Self {
        Self {
            title: step.title.clone(),
            error: step.evaluated.fit.error(),
            held_out: step.held_out,
        }
    }
}

fn runs(evaluated: &Evaluated) -> Vec<ListedRun> {
    let run = |(index, run): (usize, &ReadyRun)| ListedRun {
        file: run.file.clone(),
        conditions: conditions(run),
        error: evaluated.run_error(index),
    };
    let runs = evaluated.experiment.runs.iter();
    runs.enumerate().map(run).collect()
}
