//! The dynamic rig, implemented independently of the model crate from its data sheet.
//!
//! Units are chosen so that one absolute tolerance fits all states: mm, mm/s, bar and A.

use differential_equations::prelude::ODE;

/// Travel in mm, speed in mm/s, pressure in bar, and the currents that lift and lowering spool have followed to, A.
pub type State = [f64; 5];

/// Newton, from N/mm2 = 10 bar.
const NEWTON_PER_BAR_MM2: f64 = 0.1;
const BORE_MM: f64 = 76.0;
const DEAD_VOLUME_MM3: f64 = 0.30e6;
const BULK_MODULUS_BAR: f64 = 12_000.0;
const DEAD_WEIGHT_KG: f64 = 30.0;
const PISTON_KG: f64 = 20.0;
/// 12 000 N s/m.
const VISCOUS_N_S_MM: f64 = 12.0;
const SPOOL_LAG_S: f64 = 0.045;
const GRAVITY_M_S2: f64 = 9.806_65;
const LIFT_DROP_BAR: f64 = 4.0 - 2.5;
const LOWER_REFERENCE_BAR: f64 = 15.0;
const VACUUM_BAR: f64 = -1.0;
const RELIEF_BAR: f64 = 154.0;
const CRACKING_BAR: f64 = 2.5;
const PUMP_LPM: f64 = 54.5 * 0.88;
const MM3_S_PER_LPM: f64 = 1e6 / 60.0;

/// Table 2A: current in A, flow in l/min at the compensated drop.
const LIFT: [(f64, f64); 10] = [
    (1.126, 0.0),
    (1.138, 0.143),
    (1.568, 8.128),
    (1.974, 15.829),
    (2.319, 22.389),
    (2.640, 28.521),
    (2.858, 32.513),
    (3.070, 36.506),
    (3.252, 39.929),
    (3.5, 39.929),
];

/// Table 2B: current in A, flow in l/min at 15 bar.
const LOWER: [(f64, f64); 18] = [
    (0.999, 0.0),
    (1.017, 0.321),
    (1.042, 0.642),
    (1.072, 0.963),
    (1.138, 1.176),
    (1.502, 2.674),
    (1.544, 2.888),
    (1.574, 3.422),
    (1.744, 9.840),
    (2.035, 20.535),
    (2.271, 29.198),
    (2.567, 40.214),
    (3.022, 57.005),
    (3.040, 57.754),
    (3.070, 58.289),
    (3.119, 58.717),
    (3.306, 58.717),
    (3.5, 58.717),
];

fn table(points: &[(f64, f64)], x: f64) -> f64 {
    let inside = x.clamp(points[0].0, points[points.len() - 1].0);
    let segment = points
        .windows(2)
        .find(|pair| inside <= pair[1].0)
        .expect("x is inside the table");
    let ((x0, y0), (x1, y1)) = (segment[0], segment[1]);
    y0 + (y1 - y0) * (inside - x0) / (x1 - x0)
}

/// Linkage of the paper's Table 1, mm; C is the origin.
pub mod linkage {
    type Point = (f64, f64);

    const CYLINDER_AXIS: f64 = -95.0;
    const PIVOT: Point = (-130.0, -500.0);
    /// The pin's place at zero travel: the rocker swings as far ahead of straight down as behind it over 158 mm.
    const STROKE: f64 = 158.0;

    /// The crossing of two circles that lies to the left on the way from `a` to `b`.
    fn crossing(a: Point, radius_a: f64, b: Point, radius_b: f64) -> Point {
        let (dx, dy) = (b.0 - a.0, b.1 - a.1);
        let distance = dx.hypot(dy);
        let along = (radius_a.powi(2) - radius_b.powi(2) + distance.powi(2)) / (2.0 * distance);
        let off = (radius_a.powi(2) - along.powi(2)).sqrt();
        (
            a.0 + (along * dx - off * dy) / distance,
            a.1 + (along * dy + off * dx) / distance,
        )
    }

    /// Place of pin A, ahead of B, with the rocker `swing` rad behind straight down.
    fn pin(swing: f64) -> f64 {
        let (bx, by) = (110.0 * swing.sin(), -110.0 * swing.cos());
        bx - (220.0_f64.powi(2) - (by - CYLINDER_AXIS).powi(2)).sqrt()
    }

    /// Place of pin A at zero travel.
    pub fn pin_at_zero() -> f64 {
        let (mut low, mut high) = (0.0, 1.5);
        for _ in 0..60 {
            let swing = 0.5 * (low + high);
            if pin(swing) - pin(-swing) < STROKE {
                low = swing
            } else {
                high = swing
            }
        }
        pin(-0.5 * (low + high))
    }

    /// How far the rocker has swung behind straight down, rad.
    fn swing(pin: f64) -> f64 {
        let b = crossing((pin, CYLINDER_AXIS), 220.0, (0.0, 0.0), 110.0);
        // Of the two ways to close the chain the one with the rocker hanging.
        let other = crossing((0.0, 0.0), 110.0, (pin, CYLINDER_AXIS), 220.0);
        let (x, y) = if b.1 < other.1 { b } else { other };
        x.atan2(-y)
    }

    /// Rocker angle, degree: 90 straight down.
    pub fn rocker_degree(pin: f64) -> f64 {
        90.0 + swing(pin).to_degrees()
    }

    /// Height of G over C, mm.
    pub fn height(pin: f64) -> f64 {
        let swing = swing(pin);
        let d = (270.0 * swing.cos(), 270.0 * swing.sin());
        let (a, b) = (
            crossing(PIVOT, 400.0, d, 510.0),
            crossing(d, 510.0, PIVOT, 400.0),
        );
        let e = if a.1 < b.1 { a } else { b };
        PIVOT.1 + (e.1 - PIVOT.1) * 700.0 / 400.0
    }

    /// dh/dx and d2h/dx2 (1/mm), by differences: the height is smooth, and 0.05 mm leaves six digits.
    pub fn transmission(pin: f64) -> (f64, f64) {
        const STEP: f64 = 0.05;
        let (below, here, above) = (height(pin - STEP), height(pin), height(pin + STEP));
        (
            (above - below) / (2.0 * STEP),
            (above - 2.0 * here + below) / (STEP * STEP),
        )
    }
}

/// The rig while both currents run linearly.
pub struct Rig {
    /// Load at the hitch point, kg.
    pub load_kg: f64,
    /// Place of the pin at zero travel, mm.
    pub pin_at_zero: f64,
    /// Currents at time zero, A.
    pub currents: [f64; 2],
    /// Their slopes, A/s.
    pub slopes: [f64; 2],
}

impl Rig {
    /// Static pressure, bar.
    pub fn holding_pressure(&self, travel: f64) -> f64 {
        let (transmission, _) = linkage::transmission(self.pin_at_zero + travel);
        self.weight() * transmission / (NEWTON_PER_BAR_MM2 * area())
    }

    fn weight(&self) -> f64 {
        (self.load_kg + DEAD_WEIGHT_KG) * GRAVITY_M_S2
    }

    /// Flow into the cylinder, mm3/s.
    fn flow(&self, pressure: f64, lift: f64, lower: f64) -> f64 {
        let pump_pressure = (pressure + 4.0).min(RELIEF_BAR);
        let drop = (pump_pressure - pressure - CRACKING_BAR).max(0.0);
        let up = (table(&LIFT, lift) * (drop / LIFT_DROP_BAR).sqrt()).min(PUMP_LPM);
        let down = table(&LOWER, lower) * (pressure.max(0.0) / LOWER_REFERENCE_BAR).sqrt();
        (up - down) * MM3_S_PER_LPM
    }
}

fn area() -> f64 {
    std::f64::consts::FRAC_PI_4 * BORE_MM * BORE_MM
}

impl ODE<f64, State> for Rig {
    fn diff(&self, time: f64, state: &State, rate: &mut State) {
        let [travel, speed, kept, lift, lower] = *state;
        // Below the vacuum the pressure only keeps account of the void that has to close again.
        let pressure = kept.max(VACUUM_BAR);
        let (slope, bend) = linkage::transmission(self.pin_at_zero + travel);
        let mass_kg = self.load_kg + DEAD_WEIGHT_KG;
        let inertia_kg = mass_kg * slope * slope + PISTON_KG;
        // kg/mm * (mm/s)2 is mN.
        let centrifugal = mass_kg * slope * bend * speed * speed * 1e-3;
        let force = NEWTON_PER_BAR_MM2 * area() * pressure
            - self.weight() * slope
            - centrifugal
            - VISCOUS_N_S_MM * speed;
        let volume = DEAD_VOLUME_MM3 + area() * travel;
        rate[0] = speed;
        rate[1] = force / inertia_kg * 1e3;
        rate[2] = BULK_MODULUS_BAR / volume * (self.flow(pressure, lift, lower) - area() * speed);
        for (spool, followed) in [lift, lower].into_iter().enumerate() {
            let current = self.currents[spool] + self.slopes[spool] * time;
            rate[3 + spool] = (current - followed) / SPOOL_LAG_S;
        }
    }
}
