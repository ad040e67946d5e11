//! One freeze: a drawn machine, a move, and the instant at which its angle sensor freezes.

use hitch_quantities::units::MilliDegree;
use hitch_quantities::{Fault, Trip, ValidCalibration};
use rand::{Rng, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;

use crate::drawn_hitches::draw::{Drawn, draw};
use crate::drawn_hitches::session::{Instant, Session};

/// Longest that a hitch is watched after its sensor has frozen, ms.
const WATCHED_MS: usize = 2_500;
/// How long a hitch moves on at most once both coils are off, ms.
const COASTING_MS: usize = 600;
/// Slow moves take about this long for a degree, ms: instants are drawn within this time.
const SLOW_MS_PER_DEG: f64 = 20.0;

/// How a sensor freezes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// It repeats its last sample.
    HoldsLast,
    /// It stays where it was and keeps its noise.
    Trembles,
}

/// A machine, and how its sensor freezes.
#[derive(Debug, Clone)]
pub struct Case {
    /// The machine and its move.
    pub drawn: Drawn,
    /// How.
    pub kind: Kind,
    /// When, after the lever has moved, ms.
    pub instant_ms: usize,
}

/// Effect of a freeze.
#[derive(Debug, Clone, Copy)]
pub struct Cost {
    /// Seed of the case.
    pub seed: u64,
    /// Travel beyond that with both coils cut at the instant of the freeze, degree.
    pub extra_deg: f64,
    /// From the freeze until both coils are off for the first time, ms.
    pub off_after_ms: Option<usize>,
    /// The first fault, and the row of the envelope if it tripped.
    pub fault: Option<(Fault, Option<Trip>)>,
}

impl Case {
    /// The case of a seed.
    #[must_use]
    pub fn draw(seed: u64) -> Self {
        let mut drawn = draw(seed, 1);
        let mut random = Pcg64::seed_from_u64(seed ^ 0xF2EE_2E00);
        drawn.redraw_angle_and_lag(&mut random);
        let kind = if random.random::<bool>() {
            Kind::HoldsLast
        } else {
            Kind::Trembles
        };
        let way_deg = (drawn.angles_deg[1] - drawn.angles_deg[0]).abs();
        let longest_ms = 100.0 + way_deg * SLOW_MS_PER_DEG;
        Self {
            drawn,
            kind,
            instant_ms: random.random_range(0.0..longest_ms) as usize,
        }
    }

    /// Drives the machine.
    #[must_use]
    pub fn cost(&self, calibration: &ValidCalibration) -> Cost {
        self.cost_watched(calibration, |_| {})
    }

    /// The same; `watch` sees every millisecond from the freeze on.
    pub fn cost_watched(
        &self,
        calibration: &ValidCalibration,
        mut watch: impl FnMut(&Instant),
    ) -> Cost {
        let drawn = &self.drawn;
        let mut session = Session::new(drawn, calibration);
        session.pick_up();
        let to_deg = drawn.angles_deg[1];
        let mut shown = MilliDegree::ZERO;
        for _ in 0..=self.instant_ms {
            session.step_with(to_deg, |inputs| {
                shown = inputs.rocker_angle.unwrap_or_default();
            });
        }
        let mut hitch = session.hitch().clone();
        let (from_deg, shown_deg) = (hitch.rocker_deg(), hitch.shown_deg());
        let mut yardstick_deg: f64 = 0.0;
        for _ in 0..COASTING_MS {
            hitch.step([0.0; 2]);
            yardstick_deg = yardstick_deg.max((hitch.rocker_deg() - from_deg).abs());
        }
        let mut random = Pcg64::seed_from_u64(drawn.seed);
        let readings = drawn.readings;
        let mut frozen = || match self.kind {
            Kind::HoldsLast => shown,
            Kind::Trembles => {
                let noise: f64 = StandardNormal.sample(&mut random);
                MilliDegree((readings.shown_deg(shown_deg, noise) * 1e3).round() as i32)
            }
        };
        let mut cost = Cost {
            seed: drawn.seed,
            extra_deg: 0.0,
            off_after_ms: None,
            fault: None,
        };
        let mut travel_deg: f64 = 0.0;
        let mut left_ms = WATCHED_MS;
        for ms in 0..WATCHED_MS {
            let instant = session.step_with(to_deg, |inputs| inputs.rocker_angle = Some(frozen()));
            watch(&instant);
            travel_deg = travel_deg.max((session.hitch().rocker_deg() - from_deg).abs());
            if instant.currents_a == [0.0; 2] {
                cost.off_after_ms = cost.off_after_ms.or(Some(ms));
            }
            if cost.fault.is_none() && instant.fault.is_some() {
                cost.fault = instant.fault;
                left_ms = COASTING_MS;
            }
            left_ms -= 1;
            if left_ms == 0 {
                break;
            }
        }
        cost.extra_deg = (travel_deg - yardstick_deg).max(0.0);
        cost
    }
}
