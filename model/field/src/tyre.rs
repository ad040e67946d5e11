//! Slip of a driven axle by Brixius (ASAE paper 87-1622, bias-ply tyres; later ASAE D497).
//!
//! With the mobility number `Bn = (CI b d / W) (1 + 5 δ/h) / (1 + 3 b/d)`:
//!
//! * gross traction ratio `0.88 (1 - e^(-0.1 Bn)) (1 - e^(-7.5 s)) + 0.04`,
//! * motion resistance ratio `1/Bn + 0.04 + 0.5 s / √Bn`,
//! * net traction ratio, which is pull over load: their difference `N(s)`.
//!
//! All coefficients were compared with a second source: a public Visual Basic program for matching tractors and implements
//! has the same numbers, with the slip in percent. The first factor also stands in the tests of a public spreadsheet.
//!
//! **Slip from pull.** `N` is concave: `N'' = -49.5 K e^(-7.5 s) < 0` with `K = 0.88 (1 - e^(-0.1 Bn))`. It therefore has
//! one peak, at `s* = ln(13.2 K √Bn) / 7.5`, limited to 0 and 1, and increases up to it. For a pull between `N(0)` and
//! `N(s*)` times the load, `[0, s*]` brackets the only solution with grip, and bisection finds it. Above it no slip
//! carries the pull, and the wheels spin: slip 1.

/// Tyres of one axle.
#[derive(Debug, Clone, PartialEq)]
pub struct Tyre {
    /// Number of tyres on the axle, 1.
    pub count: f64,
    /// Section width `b`, m.
    pub width_m: f64,
    /// Overall diameter `d`, m.
    pub diameter_m: f64,
    /// Deflection over section height `δ/h`, 1.
    pub deflection_ratio: f64,
}

impl Tyre {
    /// Two tyres 18.4-38: 467 mm, 1.65 m, at a deflection of 20 % of the section height.
    #[must_use]
    pub fn two_18_4_38() -> Self {
        Self {
            count: 2.0,
            width_m: 0.467,
            diameter_m: 1.65,
            deflection_ratio: 0.2,
        }
    }

    /// Mobility number at a cone index in kPa and a load of the axle in N, above 0.
    #[must_use]
    pub fn mobility_number(&self, cone_index_kpa: f64, axle_load_n: f64) -> f64 {
        let load_kn = axle_load_n / self.count / 1000.0;
        let stiffness = 1.0 + 5.0 * self.deflection_ratio;
        let shape = 1.0 + 3.0 * self.width_m / self.diameter_m;
        cone_index_kpa * self.width_m * self.diameter_m / load_kn * stiffness / shape
    }

    /// The axle's grip at a cone index in kPa and a load in N; `None` without load.
    #[must_use]
    pub fn grip(&self, cone_index_kpa: f64, axle_load_n: f64) -> Option<Grip> {
        (axle_load_n > 0.0).then(|| Grip {
            mobility: self.mobility_number(cone_index_kpa, axle_load_n),
            axle_load_n,
        })
    }
}

/// What a loaded axle can pull.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grip {
    /// Mobility number, 1.
    pub mobility: f64,
    /// Load of the axle, N.
    pub axle_load_n: f64,
}

impl Grip {
    /// `K`: the gross traction ratio that slip can add.
    fn reach(&self) -> f64 {
        0.88 * -(-0.1 * self.mobility).exp_m1()
    }

    /// Gross traction ratio at a slip, 1.
    #[must_use]
    pub fn gross_traction_ratio(&self, slip: f64) -> f64 {
        self.reach() * -(-7.5 * slip).exp_m1() + 0.04
    }

    /// Motion resistance ratio at a slip, 1.
    #[must_use]
    pub fn motion_resistance_ratio(&self, slip: f64) -> f64 {
        self.mobility.recip() + 0.04 + 0.5 * slip / self.mobility.sqrt()
    }

    /// Pull at a slip, N.
    #[must_use]
    pub fn pull_n(&self, slip: f64) -> f64 {
        let net = self.gross_traction_ratio(slip) - self.motion_resistance_ratio(slip);
        net * self.axle_load_n
    }

    /// Slip of the largest pull, 1.
    #[must_use]
    pub fn peak_slip(&self) -> f64 {
        let steepness = 13.2 * self.reach() * self.mobility.sqrt();
        (steepness.ln() / 7.5).clamp(0.0, 1.0)
    }

    /// Largest pull, N; negative where the axle cannot even roll by itself.
    #[must_use]
    pub fn largest_pull_n(&self) -> f64 {
        self.pull_n(self.peak_slip())
    }

    /// Slip at a pull, N: 0 for a pull that rolling wheels have anyway, 1 for one that is not to be had.
    #[must_use]
    pub fn slip(&self, pull_n: f64) -> f64 {
        if pull_n <= self.pull_n(0.0) {
            return 0.0;
        }
        if pull_n > self.largest_pull_n() {
            return 1.0;
        }
        let (mut low, mut high) = (0.0, self.peak_slip());
        // Each halves the bracket; 50 reach the resolution of the numbers.
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            if self.pull_n(middle) < pull_n {
                low = middle;
            } else {
                high = middle;
            }
        }
        high
    }
}
