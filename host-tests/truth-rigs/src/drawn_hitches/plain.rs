//! A plain reference design: what the controller has to be at least as good as on a machine that it does not know.
//!
//! ```text
//! I = threshold + slope (e + integral of e / T_i)     e: distance from the set point, degree
//! ```
//!
//! The gain makes a loop with the spool lag of the data sheet critically damped: `k = 1 / 4T`, and so full opening at
//! `e = v / k`. The coil is off within the stop band, and then for the dwell of the check valve.

use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64Mcg;

use super::draw::Drawn;
use super::session::{Instant, MoveFigures, judged};
use super::shortest::SATURATION_A;
use crate::second_rig::data_sheet::{KNOWN_SPOOL_LAG_S, LIFT_TABLE, LOWER_TABLE};
use crate::second_rig::driven_hitch::DrivenHitch;

/// Speed of the fully open valves, degree/s.
const FULL_DEG_S: f64 = 80.0;
/// Integral time, s: a decade slower than the spool.
const INTEGRAL_S: f64 = 10.0 * KNOWN_SPOOL_LAG_S;
/// The coil is cut within the first of these, and on again beyond the second, degree.
const BANDS_DEG: [f64; 2] = [0.1, 0.35];
/// Both coils stay off for this long after a cut, ms.
const DWELL_MS: u32 = 150;

/// State of the reference design.
#[derive(Debug, Clone, Copy, Default)]
struct Plain {
    way: f64,
    integral_deg: f64,
    dwell_ms: u32,
}

impl Plain {
    /// Currents of lift and lowering coil for a distance from the set point, A.
    fn step(&mut self, error_deg: f64) -> [f64; 2] {
        self.dwell_ms = self.dwell_ms.saturating_sub(1);
        if self.way == 0.0 && error_deg.abs() > BANDS_DEG[1] && self.dwell_ms == 0 {
            (self.way, self.integral_deg) = (error_deg.signum(), 0.0);
        } else if self.way != 0.0 && error_deg * self.way <= BANDS_DEG[0] {
            (self.way, self.dwell_ms) = (0.0, DWELL_MS);
        }
        let full_deg = FULL_DEG_S * 4.0 * KNOWN_SPOOL_LAG_S;
        let ahead_deg = error_deg * self.way;
        let share = (ahead_deg + self.integral_deg) / full_deg;
        if share < 1.0 {
            self.integral_deg += ahead_deg * 1e-3 / INTEGRAL_S;
        }
        let current = |way: f64, threshold_a: f64, full_a: f64| {
            if self.way == way {
                threshold_a + share.min(1.0) * (full_a - threshold_a)
            } else {
                0.0
            }
        };
        [
            current(1.0, LIFT_TABLE.threshold_a, SATURATION_A[0]),
            current(-1.0, LOWER_TABLE.threshold_a, SATURATION_A[1]),
        ]
    }
}

/// Every move of a machine with the reference design.
#[must_use]
pub fn drive(drawn: &Drawn) -> Vec<MoveFigures> {
    let mut hitch = DrivenHitch::new(&drawn.physics, drawn.conditions, drawn.angles_deg[0]);
    let mut random = Pcg64Mcg::seed_from_u64(drawn.seed);
    let mut plain = Plain::default();
    judged(drawn, |to_deg| {
        let noise: f64 = StandardNormal.sample(&mut random);
        let angle_deg = drawn.readings.shown_deg(hitch.shown_deg(), noise);
        let currents_a = plain.step(hitch.shown_at_rest_deg(to_deg) - angle_deg);
        let instant = Instant {
            rocker_deg: hitch.rocker_deg(),
            cylinder_bar: hitch.cylinder_bar(),
            currents_a,
            estimated_mm: f64::NAN,
            speeds_mm_s: [f64::NAN; 2],
            fault: None,
        };
        hitch.step(currents_a);
        instant
    })
}
