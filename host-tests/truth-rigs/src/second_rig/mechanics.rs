//! Forces on the piston and how it moves: quasi-static, or with inertia and compressible oil.

use super::data_sheet::{
    AREA_M2, BAR, BULK_MODULUS_PA, DEAD_VOLUME_M3, DEAD_WEIGHT_KG, GRAVITY_M_S2,
    KNOWN_VISCOUS_N_S_M, PISTON_KG, STROKE_M, VACUUM_PA,
};
use super::hydraulics::{Circuit, Spools, rising_root};
use super::linkage::{self, Posture};
use super::physics::Physics;

/// Speed at which the hyperbolic tangent of dry friction is at three quarters, m/s.
const TRANSITION_M_S: f64 = 0.003;

/// Stiffness of the bristles, N/m: half a millimetre of presliding at 400 N.
const BRISTLES_N_M: f64 = 8e5;

/// Time in which bristles at rest creep back, s, where the rig trembles.
const BRISTLE_CREEP_S: f64 = 0.15;

/// Length of a scored spot in the bore, m.
const BUMP_LENGTH_M: f64 = 0.006;

/// Atmospheric pressure, Pa.
const ATMOSPHERE_PA: f64 = 1.013_25e5;

/// State of piston and chamber.
#[derive(Debug, Clone, Copy, Default)]
pub struct Motion {
    /// Travel, m.
    pub travel_m: f64,
    /// Speed, m/s.
    pub speed_m_s: f64,
    /// Cylinder pressure, Pa.
    pub pressure_pa: f64,
    /// Deflection of the friction's bristles, m.
    bristles_m: f64,
    /// Void under a piston that has torn the oil column, m3.
    void_m3: f64,
    /// Pressure that the hose's wall has crept to, Pa.
    wall_pa: f64,
}

/// The machine with a load on it.
#[derive(Debug, Clone)]
pub struct Machine<'a> {
    physics: &'a Physics,
    load_kg: f64,
    fluidity: f64,
    /// Whether any force depends on the speed.
    slowed: bool,
}

impl<'a> Machine<'a> {
    /// A load on the machine; `fluidity` of the oil is relative to 40 degC.
    #[must_use]
    pub fn new(physics: &'a Physics, load_kg: f64, fluidity: f64) -> Self {
        Self {
            physics,
            load_kg,
            fluidity,
            slowed: physics.is_slowed(),
        }
    }

    /// At rest at a travel, m.
    #[must_use]
    pub fn at_rest(&self, travel_m: f64) -> Motion {
        let pressure_pa = self.held_n(&linkage::at(travel_m), 0.0) / AREA_M2;
        Motion {
            travel_m,
            pressure_pa,
            wall_pa: pressure_pa,
            ..Motion::default()
        }
    }

    /// A travel, m, or that of a hitch which lies on the ground, if it is higher: there the masses come to rest.
    #[must_use]
    pub fn out_of_the_ground_m(&self, travel_m: f64) -> f64 {
        let weight_n = |travel_m: f64| self.weight_n(&linkage::at(travel_m), 0.0);
        rising_root(weight_n, 0.0, STROKE_M).max(travel_m)
    }

    /// Force that the pressure has to support, N: oil does not pull the hitch to the ground.
    fn held_n(&self, posture: &Posture, speed_m_s: f64) -> f64 {
        self.weight_n(posture, speed_m_s).max(0.0)
    }

    /// Force of load and links on the piston, N: virtual work, less the push of the ground.
    fn weight_n(&self, posture: &Posture, speed_m_s: f64) -> f64 {
        let hitch_kg = self.load_kg + DEAD_WEIGHT_KG;
        let ground_n = self.physics.ground.map_or(0.0, |ground| {
            let depth_m = ground.height_m - posture.height_m;
            let sinking_m_s = -speed_m_s * posture.slope;
            if depth_m > 0.0 {
                (ground.stiffness_n_m * depth_m + ground.damping_n_s_m * sinking_m_s).max(0.0)
            } else {
                0.0
            }
        });
        let hanging_n = hitch_kg * GRAVITY_M_S2 - ground_n;
        let tipping_n =
            self.load_kg * GRAVITY_M_S2 * self.physics.load_arm_m * posture.pitch_slope_rad_m;
        hanging_n * posture.slope + tipping_n
    }

    /// Friction beyond the known viscous one, N, against the motion.
    fn friction_n(&self, motion: &Motion, weight_n: f64, speed_m_s: f64) -> f64 {
        let friction = &self.physics.friction;
        let sign = (speed_m_s / TRANSITION_M_S).tanh();
        let dry_n = if friction.bristles {
            BRISTLES_N_M * motion.bristles_m
        } else {
            self.dry_limit_n(speed_m_s) * sign
        };
        let ripple = 1.0
            + self.physics.pin_friction_ripple
                * (std::f64::consts::TAU * motion.travel_m / STROKE_M).sin();
        let pins_n = self.physics.pin_friction * ripple * weight_n.abs() * sign;
        let from_bump = (motion.travel_m - friction.bump.1) / BUMP_LENGTH_M;
        let bump_n = friction.bump.0 * (-from_bump * from_bump).exp() * sign;
        let thickness = if friction.thickens {
            self.fluidity.sqrt().recip()
        } else {
            1.0
        };
        dry_n
            + pins_n
            + bump_n
            + friction.viscous_n_s_m * thickness * speed_m_s
            + friction.square_n_s2_m2 * speed_m_s * speed_m_s.abs()
            + self.physics.unnamed_force_n
                * (3.0 * std::f64::consts::TAU * motion.travel_m / STROKE_M).sin()
    }

    /// Dry friction that full sliding reaches, N (Stribeck).
    fn dry_limit_n(&self, speed_m_s: f64) -> f64 {
        let friction = &self.physics.friction;
        if friction.stribeck_n == 0.0 {
            return friction.coulomb_n;
        }
        let relative = (speed_m_s / friction.stribeck_speed_m_s).abs();
        let exponent = if friction.gaussian {
            relative * relative
        } else {
            relative
        };
        friction.coulomb_n + friction.stribeck_n * (-exponent).exp()
    }

    /// Rate of the bristles (LuGre, Canudas de Wit 1995), m/s.
    fn bristle_rate(&self, motion: &Motion, speed_m_s: f64) -> f64 {
        if !self.physics.friction.bristles {
            return 0.0;
        }
        let limit_m = self.dry_limit_n(speed_m_s) / BRISTLES_N_M;
        let creep = if self.physics.friction.trembles {
            (-(speed_m_s / TRANSITION_M_S).powi(2)).exp() / BRISTLE_CREEP_S
        } else {
            0.0
        };
        speed_m_s - (speed_m_s.abs() / limit_m + creep) * motion.bristles_m
    }

    /// Quasi-static step of the midpoint rule: the piston speed balances flow and forces.
    pub fn step_steady(
        &self,
        circuit: &Circuit,
        motion: &mut Motion,
        [from, to]: [Spools; 2],
        dt_s: f64,
    ) {
        let mut middle = *motion;
        middle.travel_m = within(motion.travel_m + 0.5 * dt_s * motion.speed_m_s);
        let middle = self.settled(circuit, middle, Spools::middle(from, to));
        motion.travel_m = within(motion.travel_m + dt_s * middle.speed_m_s);
        motion.bristles_m += dt_s * self.bristle_rate(motion, middle.speed_m_s);
        *motion = self.settled(circuit, *motion, to);
    }

    /// The state with the speed and pressure that balance flows and forces.
    fn settled(&self, circuit: &Circuit, motion: Motion, spools: Spools) -> Motion {
        let posture = linkage::at(motion.travel_m);
        let pressure = |speed_m_s: f64| {
            let weight_n = self.held_n(&posture, speed_m_s);
            (weight_n + self.friction_n(&motion, weight_n, speed_m_s)) / AREA_M2
        };
        let gained = |speed_m_s: f64| circuit.flows(spools, pressure(speed_m_s)).net_m3_s / AREA_M2;
        let at_rest = gained(0.0);
        let speed_m_s = if at_rest == 0.0 || !self.slowed {
            at_rest
        } else {
            // Whatever depends on speed slows the motion down.
            let excess = |speed: f64| speed - gained(speed);
            rising_root(excess, at_rest.min(0.0), at_rest.max(0.0))
        };
        Motion {
            speed_m_s,
            pressure_pa: pressure(speed_m_s),
            ..motion
        }
    }

    /// Dynamic step: classical Runge-Kutta in pieces that the orifices' settling allows, then stops and void.
    pub fn step_dynamic(
        &self,
        circuit: &Circuit,
        motion: &mut Motion,
        [from, to]: [Spools; 2],
        dt_s: f64,
    ) {
        let spools = Spools::middle(from, to);
        let pieces = (self.settling_rate(circuit, motion, spools) * dt_s)
            .ceil()
            .clamp(1.0, 40.0);
        for _ in 0..pieces as usize {
            self.runge_kutta(circuit, motion, spools, dt_s / pieces);
        }
    }

    fn runge_kutta(&self, circuit: &Circuit, motion: &mut Motion, spools: Spools, dt_s: f64) {
        let start = *motion;
        let k1 = self.rates(circuit, &start, spools);
        let k2 = self.rates(circuit, &start.moved(&k1, 0.5 * dt_s), spools);
        let k3 = self.rates(circuit, &start.moved(&k2, 0.5 * dt_s), spools);
        let k4 = self.rates(circuit, &start.moved(&k3, dt_s), spools);
        let mean: [f64; 5] = std::array::from_fn(|i| (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]) / 6.0);
        *motion = start.moved(&mean, dt_s);
        self.close_void(&start, motion);
        self.stop(motion);
    }

    /// Rates of travel, speed, pressure, bristles and hose wall.
    fn rates(&self, circuit: &Circuit, motion: &Motion, spools: Spools) -> [f64; 5] {
        let flows = circuit.flows(spools, motion.pressure_pa);
        let mut acceleration = self.acceleration(motion);
        let mut speed_m_s = motion.speed_m_s;
        if at_a_stop(motion, acceleration) {
            (speed_m_s, acceleration) = (0.0, 0.0);
        }
        let gained_m3_s = flows.net_m3_s - AREA_M2 * speed_m_s;
        let compliance = self.oil_m3_pa(motion);
        let (hose, retarded) = self.hose(motion);
        [
            speed_m_s,
            acceleration,
            (gained_m3_s - retarded) / (compliance + hose),
            self.bristle_rate(motion, speed_m_s),
            if self.physics.hose_retardation_s > 0.0 {
                (motion.pressure_pa - motion.wall_pa) / self.physics.hose_retardation_s
            } else {
                0.0
            },
        ]
    }

    fn acceleration(&self, motion: &Motion) -> f64 {
        let posture = linkage::at(motion.travel_m);
        let speed_m_s = motion.speed_m_s;
        let hitch_kg = self.load_kg + DEAD_WEIGHT_KG;
        let heavier = 1.0 + self.physics.inertia_share;
        let inertia_kg = (hitch_kg * posture.slope * posture.slope + PISTON_KG) * heavier
            + self.physics.rocker_inertia_kg_m2 * posture.rocker_slope_rad_m.powi(2);
        let weight_n = self.weight_n(&posture, speed_m_s);
        let force_n = motion.pressure_pa * AREA_M2
            - weight_n
            - heavier * hitch_kg * posture.slope * posture.bend_1_m * speed_m_s * speed_m_s
            - KNOWN_VISCOUS_N_S_M * speed_m_s
            - self.friction_n(motion, weight_n, speed_m_s);
        force_n / inertia_kg
    }

    /// Compliance of the oil, m3/Pa, with free air in it: polytropic bubbles beside stiff oil (Simscape's form).
    fn oil_m3_pa(&self, motion: &Motion) -> f64 {
        let modulus_pa = BULK_MODULUS_PA / (1.0 + self.physics.compressibility_error);
        let stiff = 1.0 / modulus_pa;
        let volume_m3 = DEAD_VOLUME_M3 + AREA_M2 * motion.travel_m.max(0.0);
        if self.physics.air_ratio == 0.0 {
            return volume_m3 * stiff;
        }
        let (share, n) = (self.physics.air_ratio, self.physics.air_exponent);
        let absolute_pa = (motion.pressure_pa + ATMOSPHERE_PA).max(0.05 * ATMOSPHERE_PA);
        let bubbles = share * (ATMOSPHERE_PA / absolute_pa).powf(1.0 / n);
        volume_m3 * (stiff + bubbles / (n * absolute_pa)) / (1.0 + bubbles)
    }

    /// Compliance of the hose that acts at once, m3/Pa, and the flow that its retarded half takes, m3/s
    /// (Kelvin-Voigt).
    fn hose(&self, motion: &Motion) -> (f64, f64) {
        let whole = self.physics.hose_m3_pa;
        if self.physics.hose_retardation_s == 0.0 {
            return (whole, 0.0);
        }
        let behind_pa = motion.pressure_pa - motion.wall_pa;
        (
            0.5 * whole,
            0.5 * whole * behind_pa / self.physics.hose_retardation_s,
        )
    }

    /// How fast orifices alone settle the pressure, 1/s.
    fn settling_rate(&self, circuit: &Circuit, motion: &Motion, spools: Spools) -> f64 {
        let probe_pa = 0.02 * BAR;
        let net = |pressure_pa: f64| circuit.flows(spools, pressure_pa).net_m3_s;
        let change = net(motion.pressure_pa) - net(motion.pressure_pa + probe_pa);
        change.abs() / probe_pa / (self.oil_m3_pa(motion) + self.hose(motion).0)
    }

    /// Oil does not pull: below the vacuum a void opens, which closes before the pressure rises.
    fn close_void(&self, start: &Motion, motion: &mut Motion) {
        let compliance = self.oil_m3_pa(start);
        if start.void_m3 > 0.0 {
            let filled_m3 = compliance * (motion.pressure_pa - start.pressure_pa);
            motion.void_m3 = start.void_m3 - filled_m3;
            motion.pressure_pa = VACUUM_PA;
            if motion.void_m3 < 0.0 {
                motion.pressure_pa -= motion.void_m3 / compliance;
                motion.void_m3 = 0.0;
            }
        } else if motion.pressure_pa < VACUUM_PA {
            motion.void_m3 = compliance * (VACUUM_PA - motion.pressure_pa);
            motion.pressure_pa = VACUUM_PA;
        }
    }

    /// The stops take a piston's speed.
    fn stop(&self, motion: &mut Motion) {
        if motion.travel_m >= STROKE_M {
            motion.travel_m = STROKE_M;
            motion.speed_m_s = motion.speed_m_s.min(0.0);
        } else if motion.travel_m <= 0.0 {
            motion.travel_m = 0.0;
            motion.speed_m_s = motion.speed_m_s.max(0.0);
        }
    }
}

impl Motion {
    fn moved(&self, rates: &[f64; 5], dt_s: f64) -> Self {
        Self {
            travel_m: self.travel_m + dt_s * rates[0],
            speed_m_s: self.speed_m_s + dt_s * rates[1],
            pressure_pa: self.pressure_pa + dt_s * rates[2],
            bristles_m: self.bristles_m + dt_s * rates[3],
            wall_pa: self.wall_pa + dt_s * rates[4],
            void_m3: self.void_m3,
        }
    }
}

/// Whether a stop carries the force on the piston: a stationary piston displaces no oil.
fn at_a_stop(motion: &Motion, acceleration: f64) -> bool {
    let (travel_m, speed_m_s) = (motion.travel_m, motion.speed_m_s);
    (travel_m >= STROKE_M && speed_m_s >= 0.0 && acceleration >= 0.0)
        || (travel_m <= 0.0 && speed_m_s <= 0.0 && acceleration <= 0.0)
}

fn within(travel_m: f64) -> f64 {
    travel_m.clamp(0.0, STROKE_M)
}
