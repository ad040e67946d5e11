//! Rocker, lift arm, lift rod and lower link, by the rocker angle; tabulated over piston travel.

use std::sync::LazyLock;

use super::data_sheet::STROKE_M;

const INTERVALS: usize = 1580;

/// The linkage's place at a piston travel.
#[derive(Debug, Clone, Copy, Default)]
pub struct Posture {
    /// Rocker angle, degree.
    pub rocker_deg: f64,
    /// Height of the hitch point over its lowest place, m.
    pub height_m: f64,
    /// dh/dx.
    pub slope: f64,
    /// d2h/dx2, 1/m.
    pub bend_1_m: f64,
    /// Turn of the load over travel, `cos(pitch) dpitch/dx`, rad/m.
    pub pitch_slope_rad_m: f64,
    /// Turn of the rocker over travel, rad/m.
    pub rocker_slope_rad_m: f64,
}

impl Posture {
    fn between(&self, other: &Self, share: f64) -> Self {
        let mix = |a: f64, b: f64| a + (b - a) * share;
        Self {
            rocker_deg: mix(self.rocker_deg, other.rocker_deg),
            height_m: mix(self.height_m, other.height_m),
            slope: mix(self.slope, other.slope),
            bend_1_m: mix(self.bend_1_m, other.bend_1_m),
            pitch_slope_rad_m: mix(self.pitch_slope_rad_m, other.pitch_slope_rad_m),
            rocker_slope_rad_m: mix(self.rocker_slope_rad_m, other.rocker_slope_rad_m),
        }
    }
}

static TABLE: LazyLock<Vec<Posture>> = LazyLock::new(tabulate);

/// The linkage at a piston travel, m; beyond the stops as at the stop.
#[must_use]
pub fn at(travel_m: f64) -> Posture {
    let place = (travel_m / STROKE_M).clamp(0.0, 1.0) * INTERVALS as f64;
    let cell = (place as usize).min(INTERVALS - 1);
    TABLE[cell].between(&TABLE[cell + 1], place - cell as f64)
}

/// Piston travel, m, at a rocker angle, degree.
#[must_use]
pub fn travel_m(rocker_deg: f64) -> f64 {
    let behind = TABLE.partition_point(|posture| posture.rocker_deg <= rocker_deg);
    let cell = behind.clamp(1, INTERVALS) - 1;
    let (low, high) = (TABLE[cell].rocker_deg, TABLE[cell + 1].rocker_deg);
    let share = ((rocker_deg - low) / (high - low)).clamp(0.0, 1.0);
    (cell as f64 + share) / INTERVALS as f64 * STROKE_M
}

/// Place of the piston pin ahead of the shaft, m, and hitch point, m, at a rocker angle, rad.
fn geometry(rocker_rad: f64) -> (f64, [f64; 2]) {
    let (b_x, b_y) = (-0.11 * rocker_rad.cos(), -0.11 * rocker_rad.sin());
    let pin = b_x - (0.22f64.powi(2) - (b_y + 0.095).powi(2)).sqrt();
    let (d_x, d_y) = (0.27 * rocker_rad.sin(), -0.27 * rocker_rad.cos());
    let (f_x, f_y) = (-0.13, -0.50);
    let (to_x, to_y) = (d_x - f_x, d_y - f_y);
    let distance = to_x.hypot(to_y);
    let along = (distance * distance + 0.40f64.powi(2) - 0.51f64.powi(2)) / (2.0 * distance);
    let off = (0.40f64.powi(2) - along * along).sqrt();
    let (e_x, e_y) = (
        (along * to_x + off * to_y) / distance,
        (along * to_y - off * to_x) / distance,
    );
    (pin, [f_x + e_x * 0.70 / 0.40, f_y + e_y * 0.70 / 0.40])
}

/// The ends between which a condition turns false, from low to high, after so many halvings.
fn bisected(
    [mut low, mut high]: [f64; 2],
    halvings: u32,
    is_low: impl Fn(f64) -> bool,
) -> [f64; 2] {
    for _ in 0..halvings {
        let middle = 0.5 * (low + high);
        if is_low(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    [low, high]
}

/// Rocker angle, rad, with the pin at a place; `pin` rises with the angle.
fn rocker_rad(pin_m: f64) -> f64 {
    let [low, high] = bisected([0.3, 2.8], 60, |angle_rad| geometry(angle_rad).0 < pin_m);
    0.5 * (low + high)
}

/// The rocker swings as far ahead of straight down as behind it.
fn pin_at_zero_m() -> f64 {
    let down = std::f64::consts::FRAC_PI_2;
    let sweep_m = |half_rad: f64| geometry(down + half_rad).0 - geometry(down - half_rad).0;
    let [low, _] = bisected([0.1, 1.2], 60, |half_rad| sweep_m(half_rad) < STROKE_M);
    geometry(down - low).0
}

/// Pitch of the load, rad, held by a top link over the lower ones: mast 0.46 m, level at mid height.
fn pitch_rad(hitch: [f64; 2], level: [f64; 2]) -> f64 {
    const PIVOT: [f64; 2] = [-0.13, -0.10];
    const MAST_M: f64 = 0.46;
    let reach = |hitch: [f64; 2], pitch: f64| {
        let x = hitch[0] - MAST_M * pitch.sin() - PIVOT[0];
        let y = hitch[1] + MAST_M * pitch.cos() - PIVOT[1];
        x.hypot(y)
    };
    let length = reach(level, 0.0);
    let [low, high] = bisected([-0.7, 0.7], 50, |pitch_rad| {
        reach(hitch, pitch_rad) > length
    });
    0.5 * (low + high)
}

fn tabulate() -> Vec<Posture> {
    let zero_m = pin_at_zero_m();
    let step_m = STROKE_M / INTERVALS as f64;
    let place = |travel_m: f64| {
        let rocker = rocker_rad(zero_m + travel_m);
        (rocker, geometry(rocker).1)
    };
    let (_, level) = place(0.5 * STROKE_M);
    let (_, lowest) = place(0.0);
    (0..=INTERVALS)
        .map(|k| {
            let travel_m = k as f64 * step_m;
            let (below, here, above) = (
                place(travel_m - step_m),
                place(travel_m),
                place(travel_m + step_m),
            );
            let [y0, y1, y2] = [below.1[1], here.1[1], above.1[1]];
            let pitch = |at: [f64; 2]| pitch_rad(at, level);
            Posture {
                rocker_deg: here.0.to_degrees(),
                height_m: y1 - lowest[1],
                slope: (y2 - y0) / (2.0 * step_m),
                bend_1_m: (y2 - 2.0 * y1 + y0) / (step_m * step_m),
                pitch_slope_rad_m: pitch(here.1).cos() * (pitch(above.1) - pitch(below.1))
                    / (2.0 * step_m),
                rocker_slope_rad_m: (above.0 - below.0) / (2.0 * step_m),
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::{at, travel_m};

    /// The data sheet's own table.
    #[test]
    fn linkage_is_the_data_sheets() {
        for (travel, rocker, slope, bend) in [
            (0.0, 44.10, 4.592, -29.1),
            (0.0395, 69.31, 4.235, -0.70),
            (0.0790, 90.14, 4.296, 2.68),
            (0.1185, 111.41, 4.365, -0.52),
            (0.1580, 135.90, 4.092, -16.3),
        ] {
            let posture = at(travel);
            assert!((posture.rocker_deg - rocker).abs() < 0.01, "{posture:?}");
            assert!((posture.slope - slope).abs() < 0.001, "{posture:?}");
            assert!((posture.bend_1_m - bend).abs() < 0.1, "{posture:?}");
            assert!((travel_m(rocker) - travel).abs() < 3e-5, "{posture:?}");
        }
    }

    /// Five to twelve degrees over the stroke are usual for a top link that is shorter than the lower links.
    #[test]
    fn load_tips_back_as_it_rises() {
        let turn: f64 = (0..158)
            .map(|mm| at(f64::from(mm) * 1e-3).pitch_slope_rad_m * 1e-3)
            .sum();
        assert!(
            (5.0..12.0).contains(&turn.to_degrees()),
            "{}",
            turn.to_degrees()
        );
    }
}
