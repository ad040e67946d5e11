//! Runs, condensed to blocks: means over a metre of travel in the soil, and over a second above it.
//!
//! A metre is longer than the short variation of the soil, which then is nearly white between blocks, and shorter than the long
//! one. The way into the soil, until the implement is at four fifths of the run's usual depth, is left out, as a depth sensor lags
//! behind it, and so is what is shallower than half of it. Above the soil only whole seconds count.

/// A sample of a log.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Time, s.
    pub time_s: f64,
    /// Ground speed, m/s.
    pub speed_m_s: f64,
    /// Working depth, m; zero or negative above the soil.
    pub depth_m: f64,
    /// Draft, N.
    pub draft_n: f64,
}

/// A run of a campaign.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// Its name: that of the log.
    pub name: String,
    /// The lane of the field; runs of one lane share their wheel tracks.
    pub lane: String,
    /// Its samples.
    pub samples: Vec<Sample>,
}

/// Means over a part of a run.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Block {
    /// Index of the run.
    pub run: usize,
    /// Travel from the start of the run to its middle, m.
    pub at_m: f64,
    /// Whether the implement is in the soil.
    pub in_soil: bool,
    /// Number of samples.
    pub samples: usize,
    /// Mean depth, cm.
    pub depth_cm: f64,
    /// Means of the speed to the powers 0, 1 and 2, in km/h.
    pub speeds: [f64; 3],
    /// Means of depth times speed to these powers, cm.
    pub depth_speeds: [f64; 3],
    /// Mean draft, N.
    pub draft_n: f64,
    /// Standard deviation of the draft between its samples, N; 0 for one sample.
    pub scatter_n: f64,
}

/// Length of a block in the soil, m.
const BLOCK_M: f64 = 1.0;
/// Way to both sides over which the depth is averaged, m.
const SMOOTH_M: f64 = 5.0;
/// Duration of a block above the soil, s.
const BLOCK_S: f64 = 1.0;
/// Parts of the usual depth of a run at which work begins and ends.
const BEGINS: f64 = 0.8;
const ENDS: f64 = 0.5;
/// Depth that a run reaches in the soil, m: less is noise of the sensor, not a depth of the standard's implements.
const SHALLOWEST_M: f64 = 0.03;
/// Longest gap between samples that travel is interpolated over, s.
const LONGEST_GAP_S: f64 = 5.0;
/// Speed below which a sample in the soil is left out, m/s: the law holds for an implement that is drawn.
const MOVING_M_S: f64 = 0.2;

/// The blocks of a run with this index.
#[must_use]
pub fn blocks(run: &Run, index: usize) -> Vec<Block> {
    let usual_m = usual_depth_m(run);
    let mut blocks = Vec::new();
    let mut open: Option<Open> = None;
    let (mut travel_m, mut works, mut spoiled) = (0.0, false, None);
    let mut last: Option<&Sample> = None;
    for sample in &run.samples {
        let step_s = last.map_or(0.0, |last| sample.time_s - last.time_s);
        travel_m += sample.speed_m_s.max(0.0) * step_s.min(LONGEST_GAP_S);
        last = Some(sample);
        let depth_m = sample.depth_m;
        let second = (sample.time_s / BLOCK_S).floor();
        works = usual_m.is_some_and(|usual_m| {
            let least = if works { ENDS } else { BEGINS };
            depth_m >= least * usual_m
        });
        let is_above = depth_m <= 0.0 || usual_m.is_none();
        if !is_above {
            spoiled = Some(second);
            open.take_if(|open| !open.in_soil && open.number == second);
        }
        let place = if is_above {
            (spoiled != Some(second)).then_some((false, second))
        } else {
            let is_drawn = works && sample.speed_m_s >= MOVING_M_S;
            is_drawn.then(|| (true, (travel_m / BLOCK_M).floor()))
        };
        let same = open.take_if(|open| Some((open.in_soil, open.number)) != place);
        blocks.extend(same.map(|done| done.block(index)));
        if let Some((in_soil, number)) = place {
            let open = open.get_or_insert_with(|| Open::new(in_soil, number));
            open.add(sample, travel_m);
        }
    }
    blocks.extend(open.map(|done| done.block(index)));
    smooth_depths(&mut blocks);
    blocks
}

/// Takes the depths in the soil from the means over [`SMOOTH_M`] to both sides. Noise of the depth between neighbouring blocks
/// would pass for changes of the depth that the draft does not follow: a draft that depends less on the depth, with an intercept.
/// A mean over a longer way misses true changes instead, which widens the scatter and leaves the slope.
fn smooth_depths(blocks: &mut [Block]) {
    let read: Vec<Block> = blocks.to_vec();
    for block in blocks.iter_mut().filter(|block| block.in_soil) {
        let is_near = |other: &&Block| other.in_soil && (other.at_m - block.at_m).abs() <= SMOOTH_M;
        let near = read.iter().filter(is_near);
        let (sum, count) = near.fold((0.0, 0.0), |(sum, count), other| {
            let samples = other.samples as f64;
            (sum + samples * other.depth_cm, count + samples)
        });
        block.depth_cm = sum / count;
        block.depth_speeds = block.speeds.map(|speed| block.depth_cm * speed);
    }
}

/// Median of the depths in the soil, m; `None` for a run above it.
fn usual_depth_m(run: &Run) -> Option<f64> {
    let depths = run.samples.iter().map(|sample| sample.depth_m);
    let mut depths: Vec<f64> = depths.filter(|depth_m| *depth_m >= SHALLOWEST_M).collect();
    depths.sort_by(f64::total_cmp);
    depths.get(depths.len() / 2).copied()
}

/// A block that is not complete.
#[derive(Debug, Default)]
struct Open {
    in_soil: bool,
    number: f64,
    samples: usize,
    travel_m: f64,
    depth_cm: f64,
    speeds: [f64; 3],
    depth_speeds: [f64; 3],
    draft_n: f64,
    draft_n2: f64,
}

impl Open {
    fn new(in_soil: bool, number: f64) -> Self {
        Self {
            in_soil,
            number,
            ..Self::default()
        }
    }

    fn add(&mut self, sample: &Sample, travel_m: f64) {
        let (depth_cm, km_h) = (100.0 * sample.depth_m, 3.6 * sample.speed_m_s);
        self.samples += 1;
        self.travel_m += travel_m;
        self.depth_cm += depth_cm;
        for (power, speed) in [1.0, km_h, km_h * km_h].into_iter().enumerate() {
            self.speeds[power] += speed;
            self.depth_speeds[power] += depth_cm * speed;
        }
        self.draft_n += sample.draft_n;
        self.draft_n2 += sample.draft_n * sample.draft_n;
    }

    fn block(&self, run: usize) -> Block {
        let count = self.samples as f64;
        let mean_n = self.draft_n / count;
        let variance_n2 = (self.draft_n2 / count - mean_n * mean_n).max(0.0);
        Block {
            run,
            at_m: self.travel_m / count,
            in_soil: self.in_soil,
            samples: self.samples,
            depth_cm: self.depth_cm / count,
            speeds: self.speeds.map(|sum| sum / count),
            depth_speeds: self.depth_speeds.map(|sum| sum / count),
            draft_n: mean_n,
            scatter_n: (variance_n2 * count / (count - 1.0).max(1.0)).sqrt(),
        }
    }
}
