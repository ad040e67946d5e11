//! Calibration of draft, mix, depth limit, depth, slip guard, ride damping and the in-work state.
//!
//! The reasons refer to a three-furrow plough of 1.2 m at 25 cm and 1.8 m/s in loam, about 18 kN, on two pins of 40 kN.

use super::parameter::parameter_group;
use crate::units::{
    Count, Micrometre, MicrometrePerSecond, MicrometrePerSecondPerBar, MilliDegree, MilliHertz,
    Millimetre, MillimetrePerSecond, Millisecond, Newton, NewtonPerDegree, PerMille, SupplyShare,
};

parameter_group! {
    /// Draft pins and draft control.
    DraftParameters, "draft" {
        /// Whether draft pins are fitted: 0 no, and all functions of draft and slip are off; 1 two pins.
        fitted: Count = 0, 0..=1, Machine;
        /// Output of the left pin without force: the middle of a ratiometric pin.
        left_zero: SupplyShare = 50_000, 20_000..=80_000, Machine;
        /// Output of the right pin without force.
        right_zero: SupplyShare = 50_000, 20_000..=80_000, Machine;
        /// Force on the left pin that adds a quarter of the supply to its output: its nominal force.
        left_span: Newton = 40_000, 5_000..=320_000, Machine;
        /// The same of the right pin.
        right_span: Newton = 40_000, 5_000..=320_000, Machine;
        /// Smallest output of a healthy pin or depth sensor: below it the wire is broken. 1.6 times the nominal force.
        output_min: SupplyShare = 10_000, 1_000..=45_000, Machine;
        /// Largest output of a healthy pin or depth sensor: above it the wire is shorted.
        output_max: SupplyShare = 90_000, 55_000..=99_000, Machine;
        /// Largest difference of the pins' forces without a draft: zeros and noise.
        difference: Newton = 2_000, 100..=100_000, Machine;
        /// Part of the draft by which the pins may differ besides: three quarters on one side, the rest on the other. A pin without force differs by all of it.
        difference_share: PerMille = 500, 0..=900, Machine;
        /// How long pins or a depth sensor have to be implausible before they are lost. They are not used in this time.
        check_time: Millisecond = 50, 1..=1_000, Machine;
        /// How long they have to be plausible before they are used again.
        healthy_time: Millisecond = 500, 1..=10_000, Machine;
        /// How long a pin under load, or a depth sensor in the soil, may stand still to the last bit and is used: a healthy one, whose noise is four steps of the converter, repeats one sample in ten. At the fastest speed the hitch moves 2 degrees in it.
        still_time: Millisecond = 20, 5..=1_000, Machine;
        /// After which time it is lost.
        frozen_time: Millisecond = 500, 50..=10_000, Machine;
        /// Mean change of a pin's output from a sample to the next above which the pin is too noisy: 4.4 times that of a healthy one. A load of the nominal force within a moment exceeds it for no longer than `check_time`.
        noise_limit: SupplyShare = 500, 50..=25_000, Machine;
        /// Low-pass on the draft in work: a wavelength of 0.56 m at 1.8 m/s (US 5143159).
        work_filter: MilliHertz = 3_200, 100..=50_000, Machine;
        /// The same while the hitch moves above the ground, where the weight bounces on the tyres (US 5143159).
        raised_filter: MilliHertz = 500, 50..=50_000, Machine;
        /// Draft above which the implement is in the soil, and below half of which it is above the ground: a twelfth of the working draft, six times what is left of the pins' noise.
        soil_draft: Newton = 1_500, 100..=100_000, Machine;
        /// Change of the draft with the angle: 0.73 kN/cm in loam at 0.9 cm a degree.
        force_per_degree: NewtonPerDegree = 650, 10..=50_000, Machine;
        /// Crossover of the draft loop: soil that becomes twice as hard is compensated within 2 s, and position control is several times as fast.
        crossover: MilliHertz = 300, 50..=300, Machine;
        /// Distance over which the implement follows the links, whose lag the loop compensates: its own length. 0 compensates nothing.
        length: Millimetre = 1_500, 0..=5_000, Machine;
        /// Speed that is assumed where the ground speed is not known.
        assumed_speed: MillimetrePerSecond = 1_800, 300..=6_000, Machine;
        /// Deviation of the draft from its set point that moves nothing.
        dead_band: PerMille = 20, 0..=200, Machine;
        /// Smallest change of the set point of position control, one move for each: a sixth of the depth. In loam half of it moves the hitch twice as often, and takes another 3 % off the deviation of the draft. In mix it is weighted as the draft. Below `margin`, or the hitch does not go below the lever.
        step: MilliDegree = 4_500, 0..=10_000, Machine;
        /// How far below the lever draft and mix may lower the hitch: 4.5 cm. The lever raises the implement out of the soil in any function.
        margin: MilliDegree = 5_000, 0..=30_000, Machine;
    }
}

parameter_group! {
    /// External depth sensor and depth control.
    DepthParameters, "depth" {
        /// Whether a depth sensor is fitted: 0 no, and depth control is off; 1 yes.
        fitted: Count = 0, 0..=1, Machine;
        /// Output of the sensor where the share touches the ground.
        zero: SupplyShare = 25_000, 5_000..=95_000, Machine;
        /// Depth that adds a quarter of the supply to the output: 40 cm over half of it. Negative for an output that falls with the depth.
        span: Micrometre = 200_000, -2_000_000..=2_000_000, Machine;
        /// Low-pass on the depth: takes 5 mm of noise to 0.5 mm, and costs half of the lag of such a sensor.
        filter: MilliHertz = 3_200, 100..=50_000, Machine;
        /// Mean change of the depth from a sample to the next above which the sensor is too noisy: 3.5 times that of a healthy one, and 30 times that of the fastest motion.
        noise_limit: Micrometre = 20_000, 1_000..=1_000_000, Machine;
        /// Time of rest of the hitch after which the sensor takes over from the lever (published by one maker).
        rest_time: Millisecond = 1_500, 0..=10_000, Machine;
        /// Deviation of the depth from its set point that moves nothing: 3.5 % of the range of 40 cm (published by one maker). On level ground a coil is switched on once a minute with it, without it 98 times; over waves of 10 m it leaves 1.7 times the deviation.
        dead_band: Micrometre = 14_000, 0..=100_000, Machine;
        /// Change of the depth with a degree of the rocker: 0.9 cm.
        per_degree: Micrometre = 9_000, 1_000..=100_000, Machine;
        /// Crossover of the depth loop: over waves of 10 m at 2.7 m/s, 0.27 Hz, it leaves 0.65 of the deviation of position control; 0.6 Hz leave 0.85, 0.3 Hz 1.15.
        crossover: MilliHertz = 1_000, 50..=2_000, Machine;
        /// Smallest change of the set point of position control, one move for each: the dead band as an angle.
        step: MilliDegree = 1_500, 0..=10_000, Machine;
        /// How far from the lever the depth may move the hitch, up and down: 9 cm. The lever raises the implement out of the soil, and what a wrong reading moves stays within it.
        margin: MilliDegree = 10_000, 0..=30_000, Machine;
    }
}

parameter_group! {
    /// Slip guard.
    SlipParameters, "slip" {
        /// Highest slip limit that the operator may set, and the limit without a setting; 0 switches the guard off.
        highest_limit: PerMille = 0, 0..=500, Machine;
        /// Ground speed from which slip is limited: 3.2 km/h.
        lowest_speed: MillimetrePerSecond = 889, 300..=3_000, Machine;
        /// Time after which a speed that was not received is lost: five periods of 100 ms.
        time_out: Millisecond = 500, 50..=5_000, Machine;
        /// How long a speed may stand still to the last bit while the other one changes.
        frozen_time: Millisecond = 3_000, 500..=60_000, Machine;
        /// Low-pass on the slip: takes the noise of a radar to a third.
        filter: MilliHertz = 800, 100..=10_000, Machine;
        /// Change of the slip with the angle, on a soft patch.
        slip_per_degree: PerMille = 13, 1..=200, Machine;
        /// Crossover of the guard: that of draft control, as the implement follows both with the same lag.
        crossover: MilliHertz = 300, 50..=500, Machine;
        /// How far the guard may raise the hitch: 13 cm, half of the depth.
        most_raise: MilliDegree = 15_000, 500..=45_000, Machine;
        /// Averaging time of the rolling radius, above the ground.
        radius_time: Millisecond = 4_000, 500..=60_000, Machine;
        /// How far the rolling radius may differ from its nominal value.
        radius_range: PerMille = 150, 0..=300, Machine;
    }
}

parameter_group! {
    /// Ride damping in transport.
    RideParameters, "ride" {
        /// Whether the hitch damps the ride: 0 no; 1 yes, which needs a sensor of the cylinder's pressure and a ground speed.
        fitted: Count = 0, 0..=1, DOWN;
        /// Piston speed for a bar of the band-passed pressure, against it: with 600 kg and a tractor of 4.5 t half of it leaves 3 % more of the pitch.
        gain: MicrometrePerSecondPerBar = 3_000, 0..=20_000, Machine;
        /// Lower corner of the band-pass: below heave and pitch of a tractor, 1 to 2.5 Hz.
        low_corner: MilliHertz = 500, 100..=2_000, Machine;
        /// Upper corner of the band-pass: above them.
        high_corner: MilliHertz = 4_000, 1_000..=20_000, Machine;
        /// Lead on the band-passed pressure, against the lag of the spools of 30 to 55 ms.
        lead: Millisecond = 40, 0..=200, Machine;
        /// Current above that of the wanted flow, as a multiple of what the spool lacks: five times the pace of the spool.
        forcing: PerMille = 4_000, 0..=5_000, Machine;
        /// Largest piston speed: 1.1 degree at 1.5 Hz.
        speed: MicrometrePerSecond = 20_000, 1_000..=20_000, DOWN;
        /// Piston speed from which a valve opens: noise of the pressure sensor, 0.3 mm/s, does not switch a coil. It closes when the speed changes its sign.
        dead_band: MicrometrePerSecond = 2_000, 0..=20_000, Machine;
        /// Largest angle from the set point. At most 3 degrees, which are the extra travel.
        band: MilliDegree = 3_000, 500..=3_000, DOWN;
        /// Time constant of the return to the set point: far below the band-pass.
        centring_time: Millisecond = 7_000, 1_000..=30_000, Machine;
        /// Ground speed above which damping begins: 8 km/h.
        begin_speed: MillimetrePerSecond = 2_222, 1_500..=10_000, UP;
        /// Ground speed below which it ends, and the envelope permits no current of it: 5 km/h. At least the default: a person walks beside the machine below it.
        end_speed: MillimetrePerSecond = 1_389, 1_389..=10_000, UP;
        /// Share of the travel between the limits above which the implement is carried.
        height: PerMille = 600, 200..=950, UP;
        /// Time after which a ground speed that was not received is lost: five periods of 100 ms. At most a second, in which a tractor that brakes stands.
        time_out: Millisecond = 500, 100..=1_000, DOWN;
    }
}

parameter_group! {
    /// When the implement is in work.
    WorkParameters, "work" {
        /// Rocker angle below which the implement is in work: where it touches the ground. 0: not set, and in-work is not available.
        angle: MilliDegree = 0, 0..=360_000, Machine;
        /// Above `angle` plus this it is out of work. Between both the draft decides; without it the state stays. 4.5 cm, the depth that draft control works at least.
        band: MilliDegree = 5_000, 100..=45_000, Machine;
    }
}
