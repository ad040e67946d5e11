//! What an adopted model leaves on the campaign that it was adopted from, as a part of the prediction of a new campaign.
//!
//! No model is exact. What it leaves on the baseline, it also leaves on a new campaign of the same machine, where it would
//! be taken for a change. The discrepancy of the model (measured less simulated) is therefore predicted as a Gaussian
//! process (Kennedy & O'Hagan 2001; Brynjarsdottir & O'Hagan 2014):
//!
//! * Its standard deviation is what the model leaves on the baseline in like states of the same regime, by channel. In a
//!   state that the baseline does not show it is the largest error that the model leaves there at all.
//! * A run with the same manoeuvre in both campaigns (bench, load or port pressure, currents) is *paired*, sample by sample.
//!   The discrepancy of the baseline is subtracted as far as the state is the same there, and the noise is that of two logs.
//! * The likeness of two states falls with the differences of pressures, flow and angle, with a length of a tenth of their
//!   ranges.
//! * The angle integrates the flow, so there the increments of the discrepancy are subtracted.

use hitch_campaign::Bench;
use hitch_plant::{Channel, Currents};

use crate::data::experiment::Experiment;
use crate::data::nuisance::Nuisance;
use crate::data::problem::Problem;
use crate::data::ready_run::{ReadyRun, Widening};
use crate::data::regime::Regime;
use crate::estimation::fit::Fit;
use crate::explanation::explain::fit_base;
use crate::parallel;

/// Largest difference of two logged currents of one manoeuvre, in sigmas of their difference.
const SAME_CURRENT: f64 = 5.0;

/// Smallest share of the samples with the same currents in two runs of one manoeuvre; the others are jumps between two
/// samples.
const SAME_SHARE: f64 = 0.9;

/// Largest differences of the set-up of two runs of one manoeuvre: load or port pressure as a share, oil, start angle.
const SAME_SETTING: f64 = 0.03;
const SAME_OIL_C: f64 = 5.0;
const SAME_START_DEG: f64 = 2.0;

/// Length of the likeness of two states, as a share of the range of a signal.
const LENGTH: f64 = 0.1;

/// Half of the time over which the speed of the angle is measured, s.
const SPEED_S: f64 = 0.1;

/// Most states of a regime that a new one is compared with.
const MOST_STATES: usize = 2_000;

/// Fewest like samples of the baseline in a state that it shows: as many as a cell of the residuals has.
const FEWEST: f64 = 30.0;

/// Signals that a state is compared by: both pressures, flow or else speed, and angle.
const SIGNALS: usize = 4;

/// A state; NaN for what is not measured.
type State = [f64; SIGNALS];

/// States with the squares of their whitened residuals by channel.
type ByRegime = [Vec<(State, [f64; 4])>; Regime::ALL.len()];

/// A baseline campaign with the model that was adopted from it.
#[derive(Debug, Clone)]
pub struct Baseline {
    experiment: Experiment,
    /// Measured less simulated of each run by channel, in its unit; NaN where the two are not compared.
    left: Vec<[Vec<f64>; 4]>,
    /// Load error of each run.
    loads: Vec<Nuisance>,
    seen: Seen,
}

/// States of the baseline, with what the model leaves in them.
#[derive(Debug, Clone)]
struct Seen {
    /// Length of the likeness by signal, in its unit.
    lengths: State,
    /// States on the flow bench and on the hitch by regime, with the squares of the whitened residuals by channel; NaN
    /// where they are not compared.
    states: [ByRegime; 2],
    /// The largest square of a whitened residual by channel.
    largest: [f64; 4],
}

impl Baseline {
    /// Compares an adopted model with the campaign that it was adopted from. Its effects stay; loads and clocks are
    /// fitted.
    #[must_use]
    pub fn new(problem: Problem<'_>) -> Self {
        let Problem { experiment, .. } = problem;
        let fit = fit_base(problem);
        Self {
            left: left(problem, &fit),
            loads: fit.estimate.nuisances.clone(),
            seen: Seen::new(experiment, &fit),
            experiment: experiment.clone(),
        }
    }

    /// A new campaign of the same machine less the discrepancy of the model.
    #[must_use]
    pub fn subtracted_from(&self, new: Experiment) -> Experiment {
        let runs = new.runs.iter();
        let runs = runs.map(|run| self.subtracted_from_run(&new, run));
        Experiment {
            runs: runs.collect(),
            ..new.without_runs()
        }
    }

    /// Number of runs of a new campaign with a run of the same manoeuvre in the baseline.
    #[must_use]
    pub fn paired(&self, new: &Experiment) -> usize {
        let runs = new.runs.iter();
        runs.filter(|run| self.pair_of(new, run).is_some()).count()
    }

    fn subtracted_from_run(&self, new: &Experiment, run: &ReadyRun) -> ReadyRun {
        let pair = self.pair_of(new, run);
        let alike = pair.map_or_else(|| vec![0.0; run.len()], |pair| pair.alike(&self.seen));
        let left_by_model = self.seen.left_by_model(run);
        let mut measured = run.measured.clone();
        let widened = Channel::ALL.map(|channel| {
            let Some(values) = &mut measured[channel.index()] else {
                return Vec::new();
            };
            let mut alike = alike.clone();
            if let Some(pair) = pair {
                let left = &pair.left[channel.index()];
                for (sample, alike) in alike.iter_mut().enumerate() {
                    let is_known = left.get(sample).is_some_and(|left| left.is_finite());
                    *alike *= f64::from(u8::from(is_known));
                }
                for (value, left) in values.iter_mut().zip(predicted(channel, left, &alike)) {
                    *value -= left;
                }
            }
            let samples = alike.iter().zip(&left_by_model);
            samples
                .map(|(alike, left)| left[channel.index()].widening(*alike))
                .collect()
        });
        let difference = run.with_measured(measured, widened);
        match pair {
            Some(pair) => difference.loaded(pair.load),
            None => difference,
        }
    }

    /// The run of the baseline with the manoeuvre of a run.
    fn pair_of<'a>(&'a self, new: &Experiment, run: &'a ReadyRun) -> Option<Pair<'a>> {
        let (one, other) = (self.experiment.current_noise, new.current_noise);
        let noise = Currents {
            lift_a: one.lift_a.hypot(other.lift_a),
            lower_a: one.lower_a.hypot(other.lower_a),
        };
        let runs = self.experiment.runs.iter().zip(&self.left).zip(&self.loads);
        let mut pairs = runs.map(|((baseline, left), &load)| Pair {
            run,
            baseline,
            left,
            load,
            noise,
        });
        pairs.find(Pair::is_one_manoeuvre)
    }
}

/// A run, and one of the baseline.
#[derive(Clone, Copy)]
struct Pair<'a> {
    run: &'a ReadyRun,
    baseline: &'a ReadyRun,
    /// Measured less simulated of the baseline by channel.
    left: &'a [Vec<f64>; 4],
    /// Load error of the baseline, relative. It is what the model of the load leaves, too, and thus the same in both.
    load: Nuisance,
    /// One sigma of the difference of their logged currents, A.
    noise: Currents,
}

impl Pair<'_> {
    /// Whether both have the same set-up and currents.
    fn is_one_manoeuvre(&self) -> bool {
        let (one, other) = (self.run, self.baseline);
        let oil_c = (one.oil_temperature_c - other.oil_temperature_c).abs();
        // NaN on a flow bench.
        let apart_deg = (one.start_angle_deg - other.start_angle_deg).abs();
        if !has_same_setting(one.bench, other.bench)
            || oil_c > SAME_OIL_C
            || apart_deg > SAME_START_DEG
        {
            return false;
        }
        let same = (0..self.samples()).filter(|&sample| self.has_same_current(sample));
        same.count() as f64 >= SAME_SHARE * one.len().max(other.len()) as f64
    }

    /// Number of samples that both have.
    fn samples(&self) -> usize {
        self.run.len().min(self.baseline.len())
    }

    /// Whether both have the same currents at the same time.
    fn has_same_current(&self, sample: usize) -> bool {
        let (one, other) = (&self.run.drive, &self.baseline.drive);
        let (own_s, its_s) = (one.time_s[sample], other.time_s[sample]);
        let step_s = own_s - one.time_s[sample.saturating_sub(1)];
        let late_s = (own_s - one.time_s[0]) - (its_s - other.time_s[0]);
        let (a, b) = (one.currents[sample], other.currents[sample]);
        late_s.abs() <= 0.5 * step_s
            && (a.lift_a - b.lift_a).abs() <= SAME_CURRENT * self.noise.lift_a
            && (a.lower_a - b.lower_a).abs() <= SAME_CURRENT * self.noise.lower_a
    }

    /// Correlation of the discrepancies of both runs by sample, from the measured states.
    fn alike(&self, seen: &Seen) -> Vec<f64> {
        let (own, its) = (states(self.run), states(self.baseline));
        let alike = |sample: usize| {
            if sample < self.samples() && self.has_same_current(sample) {
                seen.likeness(&own[sample], &its[sample])
            } else {
                0.0
            }
        };
        (0..self.run.len()).map(alike).collect()
    }
}

impl Seen {
    fn new(experiment: &Experiment, fit: &Fit) -> Self {
        let mut ranges = [(f64::INFINITY, f64::NEG_INFINITY); SIGNALS];
        let mut all: [ByRegime; 2] = Default::default();
        let mut largest = [0.0; 4];
        for (index, run) in experiment.runs.iter().enumerate() {
            let (scales, residuals) = (&fit.weights.runs[index].scale, &fit.residuals[index]);
            for (sample, state) in states(run).into_iter().enumerate() {
                for ((low, high), value) in ranges.iter_mut().zip(state) {
                    (*low, *high) = (low.min(value), high.max(value));
                }
                let squares: [f64; 4] = std::array::from_fn(|channel| {
                    let at = channel * run.len() + sample;
                    if scales[at] > 0.0 {
                        residuals[at].powi(2)
                    } else {
                        f64::NAN
                    }
                });
                for (largest, square) in largest.iter_mut().zip(squares) {
                    *largest = f64::max(*largest, square);
                }
                let of_bench = &mut all[usize::from(run.on_hitch())];
                of_bench[place(run.regimes[sample])].push((state, squares));
            }
        }
        Self {
            lengths: ranges.map(|(low, high)| LENGTH * (high - low)),
            states: all.map(|regimes| regimes.map(thinned)),
            largest,
        }
    }

    /// Correlation of the discrepancies in two states.
    fn likeness(&self, one: &State, other: &State) -> f64 {
        let signals = one.iter().zip(other).zip(&self.lengths);
        let apart = signals.map(|((one, other), length)| (one - other) / length);
        let squares = apart
            .filter(|apart| apart.is_finite())
            .map(|apart| apart * apart);
        (-0.5 * squares.sum::<f64>()).exp()
    }

    /// What the model leaves at each sample of a run by channel. A state that has not been seen counts as a single
    /// observation of the largest error.
    fn left_by_model(&self, run: &ReadyRun) -> Vec<[Left; 4]> {
        let of_bench = &self.states[usize::from(run.on_hitch())];
        let samples = states(run).into_iter().zip(&run.regimes);
        parallel::map(samples, |(state, regime)| {
            let (mut sums, mut seen) = (self.largest, [0.0; 4]);
            for (other, squares) in &of_bench[place(*regime)] {
                let likeness = self.likeness(&state, other);
                for channel in 0..4 {
                    if squares[channel].is_finite() {
                        sums[channel] += likeness * squares[channel];
                        seen[channel] += likeness;
                    }
                }
            }
            std::array::from_fn(|channel| Left {
                square: (sums[channel] / (1.0 + seen[channel])).max(1.0),
                is_seen: seen[channel] >= FEWEST,
            })
        })
    }
}

/// What the model leaves in a state.
#[derive(Clone, Copy)]
struct Left {
    /// Mean square with the noise, in units of its variance, at least one.
    square: f64,
    /// Whether the baseline shows the state.
    is_seen: bool,
}

impl Left {
    /// What a sample gets if a share of the discrepancy is known with the noise of another log.
    fn widening(self, alike: f64) -> Widening {
        let known = alike * alike;
        let discrepancy = (1.0 - known) * (self.square - 1.0);
        let variance = 1.0 + known + discrepancy;
        Widening {
            factor: variance.sqrt(),
            discrepancy: (self.is_seen || alike > 0.5).then_some(discrepancy / variance),
        }
    }
}

/// At most [`MOST_STATES`] of the states, evenly spread.
fn thinned<T: Copy>(states: Vec<T>) -> Vec<T> {
    let step = states.len().div_ceil(MOST_STATES).max(1);
    states.into_iter().step_by(step).collect()
}

/// Whether two set-ups are the same but for a few percent.
fn has_same_setting(one: Bench, other: Bench) -> bool {
    let (a, b) = match (one, other) {
        (Bench::Hitch { load_kg: a }, Bench::Hitch { load_kg: b }) => (a, b),
        (
            Bench::Flow {
                port_pressure_bar: a,
            },
            Bench::Flow {
                port_pressure_bar: b,
            },
        ) => (a, b),
        _ => return false,
    };
    (a - b).abs() <= SAME_SETTING * a.abs().max(b.abs())
}

/// The discrepancy of a new run from that of the baseline, in the channel's unit.
fn predicted(channel: Channel, left: &[f64], alike: &[f64]) -> Vec<f64> {
    let known = left
        .iter()
        .map(|left| if left.is_finite() { *left } else { 0.0 });
    let known = known.chain(std::iter::repeat(0.0)).zip(alike);
    if channel != Channel::RockerAngle {
        return known.map(|(left, alike)| alike * left).collect();
    }
    let (mut sum, mut before) = (0.0, 0.0);
    known
        .map(|(left, alike)| {
            if *alike > 0.0 {
                sum += alike * (left - before);
                before = left;
            }
            sum
        })
        .collect()
}

fn place(regime: Regime) -> usize {
    let mut all = Regime::ALL.iter();
    all.position(|&other| other == regime).unwrap_or_default()
}

/// The state at each sample of a run.
fn states(run: &ReadyRun) -> Vec<State> {
    let of = |channel: Channel| run.measured[channel.index()].clone();
    let angle = of(Channel::RockerAngle);
    let flow = of(Channel::Flow).or_else(|| angle.as_ref().map(|angle| speed(run, angle)));
    let signals = [
        of(Channel::PumpPressure),
        of(Channel::CylinderPressure),
        flow,
        angle,
    ];
    let at = |signal: &Option<Vec<f64>>, sample: usize| {
        signal.as_ref().map_or(f64::NAN, |all| all[sample])
    };
    (0..run.len())
        .map(|sample| signals.each_ref().map(|signal| at(signal, sample)))
        .collect()
}

/// Speed of the angle, degree/s.
fn speed(run: &ReadyRun, angle_deg: &[f64]) -> Vec<f64> {
    let time_s = &run.drive.time_s;
    let last = run.len() - 1;
    let (mut from, mut to) = (0, 0);
    (0..run.len())
        .map(|sample| {
            while time_s[sample] - time_s[from] > SPEED_S {
                from += 1;
            }
            while to < last && time_s[to] - time_s[sample] < SPEED_S {
                to += 1;
            }
            (angle_deg[to] - angle_deg[from]) / (time_s[to] - time_s[from])
        })
        .collect()
}

/// Measured less simulated of each run, by channel.
fn left(problem: Problem<'_>, fit: &Fit) -> Vec<[Vec<f64>; 4]> {
    let model = fit.estimate.applied_to(problem.model);
    let runs = problem.experiment.runs.iter().enumerate();
    runs.map(|(index, run)| {
        let trace = run.simulate(&model, fit.estimate.nuisances[index], &fit.estimate.clocks);
        let scales = &fit.weights.runs[index].scale;
        Channel::ALL.map(|channel| {
            let Some(measured) = &run.measured[channel.index()] else {
                return Vec::new();
            };
            let simulated = trace.channel(channel);
            let left = |sample: usize| {
                if scales[channel.index() * run.len() + sample] > 0.0 {
                    measured[sample] - simulated[sample]
                } else {
                    f64::NAN
                }
            };
            (0..run.len()).map(left).collect()
        })
    })
    .collect()
}
