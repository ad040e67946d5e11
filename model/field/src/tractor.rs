//! The tractor at work: all components of this crate in one step.
//!
//! * Speed: the driver keeps the demanded ground speed as far as the wheels, whose speed is limited, allow it at the present
//!   slip; the tractor follows this speed with a first-order lag. Wheel speed is ground speed over `1 - slip`.
//! * Depth: the links hold the share at a depth relative to the tractor. Heave, pitch and the ground's height at the share
//!   change it, then the implement follows over its own length.
//! * Draft acts in full while the tractor moves. At standstill the soil holds back as much as the wheels pull:
//!   both are blended with `tanh(v / 0.05 m/s)`.
//! * Pull is draft and the resistance of the front axle; the grip is that of the rear axle with its present load.
//!
//! The height of the links is an input: the soil's force on them is not fed back here, and the cylinder carries it.

use crate::body::{AxleLoads, Body, BodyConstants, GRAVITY_M_S2, Ground, HitchLoad, Motion};
use crate::implement::{Implement, Penetration};
use crate::noise::Noise;
use crate::sensors::draft_pins::{DraftPins, DraftPinsConstants, PinReadings};
use crate::sensors::lagged::{Lagged, LaggedConstants};
use crate::soil::{Soil, SoilPlan};
use crate::terrain::Terrain;
use crate::tyre::{Grip, Tyre};

/// Speed below which the draft of a tractor that stops is blended, m/s.
const STANDSTILL_M_S: f64 = 0.05;

/// Constants of tractor, implement and sensors.
#[derive(Debug, Clone, PartialEq)]
pub struct TractorConstants {
    /// Body on its axles.
    pub body: BodyConstants,
    /// Tyres of the driven rear axle.
    pub rear_tyre: Tyre,
    /// Motion resistance of the front axle over its load, 1.
    pub front_resistance_ratio: f64,
    /// Largest speed of the wheels in the gear, m/s.
    pub highest_wheel_speed_m_s: f64,
    /// Time constant of the ground speed, s.
    pub speed_lag_s: f64,
    /// Implement.
    pub implement: Implement,
    /// Draft pins.
    pub pins: DraftPinsConstants,
    /// Radar.
    pub ground_speed: LaggedConstants,
    /// Sensor of the wheel speed.
    pub wheel_speed: LaggedConstants,
    /// External depth sensor.
    pub depth: LaggedConstants,
    /// Accelerometer above the rear axle.
    pub acceleration: LaggedConstants,
}

impl TractorConstants {
    /// Tractor of 4.5 t with a three-furrow plough. Front resistance (Brixius at a mobility number of 33, without slip), wheel speed and lag are chosen.
    #[must_use]
    pub fn ploughing() -> Self {
        Self {
            body: BodyConstants::ploughing(),
            rear_tyre: Tyre::two_18_4_38(),
            front_resistance_ratio: 0.07,
            highest_wheel_speed_m_s: 4.0,
            speed_lag_s: 0.3,
            implement: Implement::three_furrow_plough(),
            pins: DraftPinsConstants::two_of_40_kn(),
            ground_speed: LaggedConstants::radar(),
            wheel_speed: LaggedConstants::wheel_speed(),
            depth: LaggedConstants::depth(),
            acceleration: LaggedConstants::acceleration(),
        }
    }
}

/// What hitch and driver demand.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Demand {
    /// Depth of the lower links below the height at which the share touches level ground with the implement carried, m;
    /// negative when raised. Limited to -2 and 1.
    pub link_depth_m: f64,
    /// Ground speed, m/s. Limited to 0 and 20.
    pub speed_m_s: f64,
}

/// State of the field after a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Outputs {
    /// Distance of the rear axle, m.
    pub distance_m: f64,
    /// Draft, N.
    pub draft_n: f64,
    /// Force of the soil on the implement upwards, N.
    pub vertical_n: f64,
    /// Working depth, m; negative above ground.
    pub depth_m: f64,
    /// Slip of the rear wheels, 0 to 1.
    pub slip: f64,
    /// Wheel speed, m/s.
    pub wheel_speed_m_s: f64,
    /// Ground speed, m/s.
    pub ground_speed_m_s: f64,
    /// Loads of the axles.
    pub axle_loads: AxleLoads,
    /// Heave and pitch.
    pub body: Motion,
    /// Whether the rear axle is in a headland.
    pub is_headland: bool,
    /// Readings of the sensors.
    pub readings: Readings,
}

/// Readings of the sensors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Readings {
    /// Draft pins, output over supply.
    pub pins: PinReadings,
    /// Radar, m/s.
    pub ground_speed_m_s: f64,
    /// Wheel speed, m/s.
    pub wheel_speed_m_s: f64,
    /// Depth, m.
    pub depth_m: f64,
    /// Vertical acceleration above the rear axle, m/s².
    pub acceleration_m_s2: f64,
}

/// Tractor and implement on a field.
#[derive(Debug, Clone)]
pub struct Tractor {
    constants: TractorConstants,
    soil: Soil,
    terrain: Terrain,
    body: Body,
    /// Height of the share above the ground's reference with the implement carried, m.
    carried_share_m: f64,
    penetration: Penetration,
    distance_m: f64,
    speed_m_s: f64,
    /// Slip that the pull needed at the end of the last step.
    needed_slip: f64,
    pins: DraftPins,
    ground_speed: Lagged,
    wheel_speed: Lagged,
    depth: Lagged,
    acceleration: Lagged,
}

/// Forces of the soil.
struct SoilForces {
    resistance_n: f64,
    draft_n: f64,
    vertical_n: f64,
}

/// Slip and speed of the driven wheels.
struct Wheels {
    /// Slip that the pull needs, 0 to 1.
    needed_slip: f64,
    /// Slip of the present speeds, 0 to 1.
    slip: f64,
    speed_m_s: f64,
}

impl Tractor {
    /// A tractor that stands at distance 0 with its implement raised by half a metre. The seed determines soil and noise.
    #[must_use]
    pub fn new(constants: TractorConstants, soil: SoilPlan, terrain: Terrain, seed: u64) -> Self {
        let noise = |stream| Noise::new(seed, stream);
        let lagged = |constants: &LaggedConstants, value, stream| {
            Lagged::new(constants.clone(), value, noise(stream))
        };
        let carried = carried(&constants.implement);
        let level = Body::at_rest(constants.body.clone(), Ground::default(), carried);
        let ground = ground(&constants, &terrain, 0.0);
        let raised_m = -0.5;
        Self {
            carried_share_m: share_m(&constants, level.motion()),
            body: Body::at_rest(constants.body.clone(), ground, carried),
            soil: Soil::new(soil, noise(0)),
            terrain,
            penetration: Penetration::new(raised_m),
            distance_m: 0.0,
            speed_m_s: 0.0,
            needed_slip: 0.0,
            pins: DraftPins::new(constants.pins.clone(), noise(1)),
            ground_speed: lagged(&constants.ground_speed, 0.0, 2),
            wheel_speed: lagged(&constants.wheel_speed, 0.0, 3),
            depth: lagged(&constants.depth, raised_m, 4),
            acceleration: lagged(&constants.acceleration, 0.0, 5),
            constants,
        }
    }

    /// Constants of tractor, implement and sensors.
    #[must_use]
    pub const fn constants(&self) -> &TractorConstants {
        &self.constants
    }

    /// The soil.
    #[must_use]
    pub const fn soil(&self) -> &Soil {
        &self.soil
    }

    /// The soil, to change what is ahead.
    pub const fn soil_mut(&mut self) -> &mut Soil {
        &mut self.soil
    }

    /// Heights of the ground.
    #[must_use]
    pub const fn terrain(&self) -> &Terrain {
        &self.terrain
    }

    /// Goes on by `dt_s`, s, limited to 1 µs and 0.1 s. Steps of 1 to 10 ms agree. Demands that are not numbers count as 0.
    pub fn step(&mut self, demand: Demand, dt_s: f64) -> Outputs {
        let link_depth_m = limited(demand.link_depth_m, -2.0, 1.0);
        let demand_m_s = limited(demand.speed_m_s, 0.0, 20.0);
        let dt_s = limited(dt_s, 1e-6, 0.1);

        let travel_m = self.travel_m(demand_m_s, dt_s);
        self.distance_m += travel_m;
        let share_at_m = self.distance_m - self.constants.implement.share_m;
        let sunk_m = self.carried_share_m - share_m(&self.constants, self.body.motion());
        let set_m = link_depth_m + sunk_m + self.terrain.height_m(share_at_m);
        self.penetration
            .advance(set_m, self.constants.implement.length_m, travel_m);

        let forces = self.soil_forces(share_at_m, demand_m_s);
        let wheels = self.wheels(forces.resistance_n, demand_m_s);
        self.needed_slip = wheels.needed_slip;
        let ground = ground(&self.constants, &self.terrain, self.distance_m);
        self.body.step(ground, self.hitch_load(&forces), dt_s);
        self.outputs(&forces, &wheels, dt_s)
    }

    /// Travel over a step, m, at whose end the speed is that of the lag: exact for a constant slip.
    fn travel_m(&mut self, demand_m_s: f64, dt_s: f64) -> f64 {
        let lag_s = self.constants.speed_lag_s;
        let attainable_m_s = self.constants.highest_wheel_speed_m_s * (1.0 - self.needed_slip);
        let aim_m_s = demand_m_s.min(attainable_m_s);
        let off_m_s = self.speed_m_s - aim_m_s;
        let gone = -(-dt_s / lag_s).exp_m1();
        self.speed_m_s = aim_m_s + (1.0 - gone) * off_m_s;
        aim_m_s * dt_s + off_m_s * lag_s * gone
    }

    fn soil_forces(&mut self, share_at_m: f64, demand_m_s: f64) -> SoilForces {
        let implement = &self.constants.implement;
        let depth_m = self.penetration.depth_m();
        let texture = self.soil.texture(share_at_m);
        let uniform_n = implement.draft_n(texture, depth_m, self.speed_m_s);
        let factor = self.soil.draft_factor(share_at_m);
        let resistance_n = uniform_n * factor + self.soil.stone_force_n(share_at_m, depth_m);
        let moving = (self.speed_m_s / STANDSTILL_M_S).tanh();
        let held_n = if demand_m_s > 0.0 {
            let largest_n = self.grip().map_or(0.0, |grip| grip.largest_pull_n());
            resistance_n.min(largest_n.max(0.0))
        } else {
            0.0
        };
        let draft_n = moving * resistance_n + (1.0 - moving) * held_n;
        SoilForces {
            resistance_n,
            draft_n,
            vertical_n: implement.vertical_force_n(draft_n, texture),
        }
    }

    /// Grip of the rear axle; `None` if it has no load.
    fn grip(&self) -> Option<Grip> {
        let cone_index_kpa = self.soil.cone_index_kpa(self.distance_m);
        let load_n = self.body.axle_loads().rear_n;
        self.constants.rear_tyre.grip(cone_index_kpa, load_n)
    }

    fn wheels(&self, resistance_n: f64, demand_m_s: f64) -> Wheels {
        let front_n = self.body.axle_loads().front_n;
        let pull_n = resistance_n + self.constants.front_resistance_ratio * front_n;
        let needed_slip = self.grip().map_or(1.0, |grip| grip.slip(pull_n));
        let highest_m_s = self.constants.highest_wheel_speed_m_s;
        // Without a demand no power goes to the wheels.
        let limit_m_s = self
            .speed_m_s
            .max(if demand_m_s > 0.0 { highest_m_s } else { 0.0 });
        let speed_m_s = if needed_slip < 1.0 {
            (self.speed_m_s / (1.0 - needed_slip)).min(limit_m_s)
        } else {
            limit_m_s
        };
        Wheels {
            needed_slip,
            // The limit leaves less slip than the pull asks for, until the tractor has slowed down.
            slip: if speed_m_s > 0.0 {
                1.0 - self.speed_m_s / speed_m_s
            } else {
                0.0
            },
            speed_m_s,
        }
    }

    fn hitch_load(&self, forces: &SoilForces) -> HitchLoad {
        let implement = &self.constants.implement;
        let depth_m = self.penetration.depth_m().max(0.0);
        carried(implement)
            .with_force(forces.vertical_n, implement.share_m)
            .with_draft(forces.draft_n, implement.resistance_depth_ratio * depth_m)
    }

    fn outputs(&mut self, forces: &SoilForces, wheels: &Wheels, dt_s: f64) -> Outputs {
        let body = *self.body.motion();
        let depth_m = self.penetration.depth_m();
        let ground_speed_m_s = self.speed_m_s;
        let rear_m = -self.constants.body.centre_before_rear_m();
        Outputs {
            distance_m: self.distance_m,
            draft_n: forces.draft_n,
            vertical_n: forces.vertical_n,
            depth_m,
            slip: wheels.slip,
            wheel_speed_m_s: wheels.speed_m_s,
            ground_speed_m_s,
            axle_loads: self.body.axle_loads(),
            body,
            is_headland: self.soil.is_headland(self.distance_m),
            readings: Readings {
                pins: self.pins.read(forces.draft_n),
                ground_speed_m_s: self.ground_speed.read(ground_speed_m_s, dt_s),
                wheel_speed_m_s: self.wheel_speed.read(wheels.speed_m_s, dt_s),
                depth_m: self.depth.read(depth_m, dt_s),
                acceleration_m_s2: self.acceleration.read(body.vertical_m_s2(rear_m), dt_s),
            },
        }
    }
}

/// Load of the hitch with the implement carried.
fn carried(implement: &Implement) -> HitchLoad {
    HitchLoad::default().with_force(-implement.mass_kg * GRAVITY_M_S2, implement.centre_m)
}

/// Height of the share's place on the body above its static one, m.
fn share_m(constants: &TractorConstants, motion: &Motion) -> f64 {
    motion.height_m(-(constants.body.centre_before_rear_m() + constants.implement.share_m))
}

fn ground(constants: &TractorConstants, terrain: &Terrain, distance_m: f64) -> Ground {
    Ground {
        front_m: terrain.height_m(distance_m + constants.body.wheelbase_m),
        rear_m: terrain.height_m(distance_m),
    }
}

fn limited(value: f64, low: f64, high: f64) -> f64 {
    if value.is_nan() {
        0.0_f64.clamp(low, high)
    } else {
        value.clamp(low, high)
    }
}
