//! Distances of the piston that correspond to angles of the hitch.
//!
//! Noise of a position, an overshoot and the edge of a deceleration are angles of a hitch: play of its pins, noise of its
//! sensor. A linkage that moves its piston further for each degree makes longer distances of them:
//!
//! ```text
//! distance = angle * (travel of the table / angle of the table)
//! ```

use hitch_quantities::calibration::linkage::{LINKAGE_POINTS, LinkageTable};
use hitch_quantities::fixed::{Divisor, mul_div};
use hitch_quantities::units::{Micrometre, MicrometrePerSecond};

/// Angles in millionths of a degree.
const OVERSHOOT_UDEG: i32 = 581_340;
const NOISE_UDEG: i32 = 174_400;
/// In a second.
const DECELERATION_UDEG: i32 = 2_325_370;

/// The distances of one linkage.
#[derive(Clone, Copy, Debug)]
pub struct TravelDistances {
    /// A lift that overshoots by more than this has an oscillating load: 0.6 degree.
    pub overshoot: Micrometre,
    /// Sigma of the distance error of a move that does not depend on the distance: averaged sensor, play of pins, closing
    /// of the valve. 0.17 degree.
    pub noise: Micrometre,
    /// A speed below the peak by this much is a deceleration: corrections of the map are smaller. 2.3 degrees a second.
    pub deceleration: MicrometrePerSecond,
}

impl TravelDistances {
    /// The distances of a linkage.
    #[must_use]
    pub fn of(linkage: &LinkageTable) -> Self {
        const PIECES: i32 = LINKAGE_POINTS as i32 - 1;
        let [first, .., last] = linkage.travel;
        let travel = (last - first).0;
        let angle = linkage.angle_step.0.saturating_mul(PIECES);
        let angle_udeg = Divisor::at_least_one(angle.saturating_mul(1_000));
        let distance = |udeg: i32| mul_div(udeg, travel, angle_udeg);
        Self {
            overshoot: Micrometre(distance(OVERSHOOT_UDEG)),
            noise: Micrometre(distance(NOISE_UDEG)),
            deceleration: MicrometrePerSecond(distance(DECELERATION_UDEG)),
        }
    }
}

#[cfg(test)]
mod tests {
    use hitch_quantities::calibration::nominal::LINKAGE;

    use super::*;

    #[test]
    fn distances_grow_with_the_travel_for_each_degree() {
        let nominal = TravelDistances::of(&LINKAGE);
        // A degree of the rig is 1.72 mm.
        assert!((nominal.overshoot.0 - 1_000).abs() <= 1, "{nominal:?}");
        let longer = LinkageTable {
            travel: LINKAGE.travel.map(|travel| Micrometre(2 * travel.0)),
            ..LINKAGE
        };
        let longer = TravelDistances::of(&longer);
        for (long, short) in [
            (longer.overshoot.0, nominal.overshoot.0),
            (longer.noise.0, nominal.noise.0),
            (longer.deceleration.0, nominal.deceleration.0),
        ] {
            assert!((long - 2 * short).abs() <= 1, "{long}, {short}");
        }
    }
}
