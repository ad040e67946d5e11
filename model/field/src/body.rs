//! Heave and pitch of a tractor on the springs and dampers of its two axles.
//!
//! With the height `z` of the centre of gravity above its static one, the pitch `θ` (nose up), the distances `a` and `b` of
//! the axles from the centre, and the ground's heights `g`:
//!
//! * axle forces `F = -k (y - g) - c (ẏ - ġ)`, with `y_front = z + a θ`, `y_rear = z - b θ`;
//! * `m z̈ = F_front + F_rear + P`;
//! * `J θ̈ = a F_front - b F_rear + M - b P`.
//!
//! `P` is the hitch's force upwards, and `M` its moment about the rear axle's contact with the ground. Draft `D` at the depth
//! `d` below ground, with the traction that balances it, has the moment `-D d`: the height of the centre cancels.
//!
//! Axle loads in statics: `R_front = (m g b - M) / L`, `R_rear = m g - P - R_front`.
//!
//! Steps are those of constant average acceleration (Newmark, β = 1/4), which add no energy at any step. Springs also pull:
//! a wheel that leaves the ground is not described, and its load is given as 0.

/// Acceleration of gravity, m/s².
pub const GRAVITY_M_S2: f64 = 9.81;

/// Constants of a tractor's body.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyConstants {
    /// Mass, kg.
    pub mass_kg: f64,
    /// Moment of inertia about the pitch axis, kg m².
    pub pitch_inertia_kg_m2: f64,
    /// Stiffness of the front axle, N/m.
    pub front_stiffness_n_m: f64,
    /// Stiffness of the rear axle, N/m.
    pub rear_stiffness_n_m: f64,
    /// Damping of the front axle, N s/m.
    pub front_damping_n_s_m: f64,
    /// Damping of the rear axle, N s/m.
    pub rear_damping_n_s_m: f64,
    /// Distance of the axles, m.
    pub wheelbase_m: f64,
    /// Centre of gravity behind the front axle, m.
    pub centre_behind_front_m: f64,
}

impl BodyConstants {
    /// The light tractor of simscape/Row-Crop-Tractor-Simscape (`sm_tractor_row_crop_param.m`): heave 1.19 Hz, pitch 1.57 Hz.
    #[must_use]
    pub fn published_light() -> Self {
        Self {
            mass_kg: 1600.0,
            pitch_inertia_kg_m2: 1500.0,
            front_stiffness_n_m: 40e3,
            rear_stiffness_n_m: 50e3,
            front_damping_n_s_m: 3.5e3,
            rear_damping_n_s_m: 3.5e3,
            wheelbase_m: 2.551,
            centre_behind_front_m: 1.5,
        }
    }

    /// A tractor of 4.5 t for a three-furrow plough: heave 2.3 Hz, pitch 2.6 Hz. Stiffness is load over deflection of the
    /// tyres: 40 kN at a fifth of 0.37 m of section height behind, 17 kN at 46 mm in front. With the springs of the light
    /// tractor in proportion to the mass, statics let the soil pull the share about 0.1 m deeper than the links set it.
    /// Inertia (1.1 m of gyration) and damping (a tenth of critical in heave) are chosen.
    #[must_use]
    pub fn ploughing() -> Self {
        Self {
            mass_kg: 4500.0,
            pitch_inertia_kg_m2: 5500.0,
            front_stiffness_n_m: 370e3,
            rear_stiffness_n_m: 540e3,
            front_damping_n_s_m: 5e3,
            rear_damping_n_s_m: 8e3,
            wheelbase_m: 2.551,
            centre_behind_front_m: 1.5,
        }
    }

    /// Centre of gravity in front of the rear axle, m.
    #[must_use]
    pub fn centre_before_rear_m(&self) -> f64 {
        self.wheelbase_m - self.centre_behind_front_m
    }

    /// Axle loads in statics on level ground, N; not limited to 0.
    #[must_use]
    pub fn static_loads(&self, hitch: HitchLoad) -> AxleLoads {
        let weight_n = self.mass_kg * GRAVITY_M_S2;
        let moment_n_m = weight_n * self.centre_before_rear_m() - hitch.nose_up_n_m;
        let front_n = moment_n_m / self.wheelbase_m;
        AxleLoads {
            front_n,
            rear_n: weight_n - hitch.up_n - front_n,
        }
    }

    /// Sums of a property of the axles as forces on heave and pitch: `[Σ p, Σ p x, Σ p x²]`.
    fn sums(&self, front: f64, rear: f64) -> [f64; 3] {
        let (a, b) = (self.centre_behind_front_m, self.centre_before_rear_m());
        [
            front + rear,
            front * a - rear * b,
            front * a * a + rear * b * b,
        ]
    }

    fn stiffness(&self) -> [f64; 3] {
        self.sums(self.front_stiffness_n_m, self.rear_stiffness_n_m)
    }

    fn damping(&self) -> [f64; 3] {
        self.sums(self.front_damping_n_s_m, self.rear_damping_n_s_m)
    }
}

/// What a hitch puts on the tractor.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct HitchLoad {
    /// Force upwards, N.
    pub up_n: f64,
    /// Moment about the rear axle's contact with the ground, nose up, N m.
    pub nose_up_n_m: f64,
}

impl HitchLoad {
    /// Adds a force upwards, N, at a distance behind the rear axle, m.
    #[must_use]
    pub fn with_force(self, up_n: f64, behind_m: f64) -> Self {
        Self {
            up_n: self.up_n + up_n,
            nose_up_n_m: self.nose_up_n_m - up_n * behind_m,
        }
    }

    /// Adds a draft, N, at a depth below ground, m.
    #[must_use]
    pub fn with_draft(self, draft_n: f64, depth_m: f64) -> Self {
        Self {
            nose_up_n_m: self.nose_up_n_m - draft_n * depth_m,
            ..self
        }
    }
}

/// Heights of the ground under the axles.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Ground {
    /// Under the front axle, m.
    pub front_m: f64,
    /// Under the rear axle, m.
    pub rear_m: f64,
}

/// Loads of the axles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AxleLoads {
    /// Front, N.
    pub front_n: f64,
    /// Rear, N.
    pub rear_n: f64,
}

/// Heave and pitch with their derivatives.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Motion {
    /// Heave of the centre above its height without hitch on ground of height 0, m.
    pub heave_m: f64,
    /// Its speed, m/s.
    pub heave_m_s: f64,
    /// Its acceleration, m/s².
    pub heave_m_s2: f64,
    /// Pitch, nose up, rad.
    pub pitch_rad: f64,
    /// Its speed, rad/s.
    pub pitch_rad_s: f64,
    /// Its acceleration, rad/s².
    pub pitch_rad_s2: f64,
}

impl Motion {
    /// Height of a point at a distance in front of the centre, m, above its static one.
    #[must_use]
    pub fn height_m(&self, before_m: f64) -> f64 {
        self.heave_m + before_m * self.pitch_rad
    }

    /// Vertical acceleration of a point at a distance in front of the centre, m, in m/s².
    #[must_use]
    pub fn vertical_m_s2(&self, before_m: f64) -> f64 {
        self.heave_m_s2 + before_m * self.pitch_rad_s2
    }
}

/// A body in motion.
#[derive(Debug, Clone)]
pub struct Body {
    constants: BodyConstants,
    motion: Motion,
    ground: Ground,
    ground_speed: Ground,
    hitch: HitchLoad,
}

impl Body {
    /// A body at rest in equilibrium with the ground and the hitch.
    #[must_use]
    pub fn at_rest(constants: BodyConstants, ground: Ground, hitch: HitchLoad) -> Self {
        let free = constants.static_loads(HitchLoad::default());
        let loaded = constants.static_loads(hitch);
        let front_m =
            ground.front_m - (loaded.front_n - free.front_n) / constants.front_stiffness_n_m;
        let rear_m = ground.rear_m - (loaded.rear_n - free.rear_n) / constants.rear_stiffness_n_m;
        let pitch_rad = (front_m - rear_m) / constants.wheelbase_m;
        let heave_m = rear_m + constants.centre_before_rear_m() * pitch_rad;
        Self::displaced(constants, ground, hitch, heave_m, pitch_rad)
    }

    /// A body that is let go without speed at a heave in m and a pitch in rad.
    #[must_use]
    pub fn displaced(
        constants: BodyConstants,
        ground: Ground,
        hitch: HitchLoad,
        heave_m: f64,
        pitch_rad: f64,
    ) -> Self {
        let mut body = Self {
            constants,
            motion: Motion {
                heave_m,
                pitch_rad,
                ..Motion::default()
            },
            ground,
            ground_speed: Ground::default(),
            hitch,
        };
        let [force_n, moment_n_m] = body.forces(body.motion);
        body.motion.heave_m_s2 = force_n / body.constants.mass_kg;
        body.motion.pitch_rad_s2 = moment_n_m / body.constants.pitch_inertia_kg_m2;
        body
    }

    /// Present motion.
    #[must_use]
    pub fn motion(&self) -> &Motion {
        &self.motion
    }

    /// Constants.
    #[must_use]
    pub fn constants(&self) -> &BodyConstants {
        &self.constants
    }

    /// Goes on by `dt_s`, s, above 0, to these heights of the ground and this load of the hitch.
    pub fn step(&mut self, ground: Ground, hitch: HitchLoad, dt_s: f64) {
        self.ground_speed = Ground {
            front_m: (ground.front_m - self.ground.front_m) / dt_s,
            rear_m: (ground.rear_m - self.ground.rear_m) / dt_s,
        };
        (self.ground, self.hitch) = (ground, hitch);
        let old = self.motion;
        // The motion without the new acceleration, and what a unit of it adds.
        let guess = Motion {
            heave_m: old.heave_m + dt_s * (old.heave_m_s + 0.25 * dt_s * old.heave_m_s2),
            heave_m_s: old.heave_m_s + 0.5 * dt_s * old.heave_m_s2,
            pitch_rad: old.pitch_rad + dt_s * (old.pitch_rad_s + 0.25 * dt_s * old.pitch_rad_s2),
            pitch_rad_s: old.pitch_rad_s + 0.5 * dt_s * old.pitch_rad_s2,
            ..old
        };
        let (speed_s, travel_s2) = (0.5 * dt_s, 0.25 * dt_s * dt_s);
        let [damping, stiffness] = [self.constants.damping(), self.constants.stiffness()];
        let resistance = |index: usize| speed_s * damping[index] + travel_s2 * stiffness[index];
        let heaving = self.constants.mass_kg + resistance(0);
        let coupling = resistance(1);
        let pitching = self.constants.pitch_inertia_kg_m2 + resistance(2);
        let [force_n, moment_n_m] = self.forces(guess);
        let determinant = heaving * pitching - coupling * coupling;
        let heave_m_s2 = (force_n * pitching - moment_n_m * coupling) / determinant;
        let pitch_rad_s2 = (moment_n_m * heaving - force_n * coupling) / determinant;
        self.motion = Motion {
            heave_m: guess.heave_m + travel_s2 * heave_m_s2,
            heave_m_s: guess.heave_m_s + speed_s * heave_m_s2,
            heave_m_s2,
            pitch_rad: guess.pitch_rad + travel_s2 * pitch_rad_s2,
            pitch_rad_s: guess.pitch_rad_s + speed_s * pitch_rad_s2,
            pitch_rad_s2,
        };
    }

    /// Loads of the axles on the ground, N.
    #[must_use]
    pub fn axle_loads(&self) -> AxleLoads {
        let free = self.constants.static_loads(HitchLoad::default());
        let [front_n, rear_n] = self.axle_forces(self.motion);
        AxleLoads {
            front_n: (free.front_n + front_n).max(0.0),
            rear_n: (free.rear_n + rear_n).max(0.0),
        }
    }

    /// Energy of motion and springs above that of rest without hitch, J.
    #[must_use]
    pub fn energy_j(&self) -> f64 {
        let (constants, motion) = (&self.constants, &self.motion);
        let [front_m, rear_m] = self.compressions_m(*motion);
        0.5 * (constants.mass_kg * motion.heave_m_s.powi(2)
            + constants.pitch_inertia_kg_m2 * motion.pitch_rad_s.powi(2)
            + constants.front_stiffness_n_m * front_m.powi(2)
            + constants.rear_stiffness_n_m * rear_m.powi(2))
    }

    fn compressions_m(&self, motion: Motion) -> [f64; 2] {
        [
            self.ground.front_m - motion.height_m(self.constants.centre_behind_front_m),
            self.ground.rear_m - motion.height_m(-self.constants.centre_before_rear_m()),
        ]
    }

    /// Forces of front and rear axle on the body beyond those at rest without hitch, N.
    fn axle_forces(&self, motion: Motion) -> [f64; 2] {
        let constants = &self.constants;
        let [front_m, rear_m] = self.compressions_m(motion);
        let front_m_s = self.ground_speed.front_m
            - (motion.heave_m_s + constants.centre_behind_front_m * motion.pitch_rad_s);
        let rear_m_s = self.ground_speed.rear_m
            - (motion.heave_m_s - constants.centre_before_rear_m() * motion.pitch_rad_s);
        [
            constants.front_stiffness_n_m * front_m + constants.front_damping_n_s_m * front_m_s,
            constants.rear_stiffness_n_m * rear_m + constants.rear_damping_n_s_m * rear_m_s,
        ]
    }

    /// Force on the heave and moment on the pitch, N and N m.
    fn forces(&self, motion: Motion) -> [f64; 2] {
        let rear_m = self.constants.centre_before_rear_m();
        let [front_n, rear_n] = self.axle_forces(motion);
        [
            front_n + rear_n + self.hitch.up_n,
            self.constants.centre_behind_front_m * front_n - rear_m * (rear_n + self.hitch.up_n)
                + self.hitch.nose_up_n_m,
        ]
    }
}
