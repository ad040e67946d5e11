//! Every number of the controller that isn't a curve, with its unit, its range and its reason.
//!
//! The reasons refer to the rig this project starts from: 45.37 cm2 cylinder with 158 mm stroke, valves
//! of the EHR5 class, 50 to 250 kg on the hitch. Times are in steps of the controller, 1 ms each.

use super::parameter::parameter_group;
use crate::units::{
    AmperePerSecond, Count, Micrometre, MicrometrePerSecond, Microsecond, MilliAmp,
    MilliAmpPerSecond, MilliBar, MilliDegree, MilliDegreePerSecond, MilliOhm, MilliOhmPerSecond,
    MilliVolt, MillimetrePerSecondSquared, Millisecond, PerMille, PerSecond, RevolutionPerMinute,
    SquareMillimetre,
};

parameter_group! {
    /// The hydraulic circuit, as far as the controller uses it.
    HydraulicParameters, "hydraulics" {
        /// Piston area: turns piston speed into flow. 76 mm bore.
        piston_area: SquareMillimetre = 4537, 500..=50_000, Machine;
        /// Travel of the load for each travel of the piston, the mean over the stroke: gravity accelerates a sinking piston with as many times less.
        load_ratio: PerMille = 4_300, 500..=30_000, Machine;
        /// Time constant of the lift valve's solenoid and spool: what flows on after the coil has been told to stop.
        spool_lag: Millisecond = 40, 0..=500, Machine;
        /// The same of the lowering valve. Two valves of one kind differ by 10 ms and more.
        lower_spool_lag: Millisecond = 40, 0..=500, Machine;
        /// Lag of the pressure compensator. A lifted load swings on a compensator that lags: with a value above zero it is lifted with the gentle ramps from the first move on, otherwise once its motion shows the lag, which it cannot behind a slow angle sensor.
        compensator_lag: Millisecond = 0, 0..=200, Machine;
        /// Hysteresis of coil and spool: how much further the current has to fall than it rose for the same flow. 2 % of the range, half of what valves have with dither, for a machine that has not been taught; teaching measures it.
        hysteresis: MilliAmp = 80, 0..=1_000, Machine;
        /// Pressure drop at which the lowering table was measured.
        reference_drop: MilliBar = 15_000, 1_000..=250_000, Machine;
        /// Pressure drop assumed for lowering until a sensor or a lowering move shows it: that of a load of 150 kg.
        assumed_drop: MilliBar = 15_000, 1_000..=250_000, Machine;
        /// Smallest drop that the lowering map uses: below it friction dominates, and the current from the square root is not bounded.
        smallest_drop: MilliBar = 1_000, 200..=10_000, Machine;
        /// Largest drop that the lowering map uses: above the relief setting there are only shocks.
        largest_drop: MilliBar = 200_000, 20_000..=350_000, Machine;
        /// What the sensor of the cylinder shows without pressure: it is taken off the reading.
        pressure_offset: MilliBar = 0, -20_000..=20_000, Machine;
        /// Low-pass on the cylinder pressure: slower than the load swinging on its oil (4 Hz with air in it, and up), whose damping a faster map would cancel.
        pressure_filter: Millisecond = 240, 1..=1_000, Machine;
        /// Time in which the load estimate follows the sinking speed when there is no pressure sensor.
        drop_learning: Millisecond = 250, 20..=5_000, Machine;
        /// Setting of the pump's relief valve.
        relief_pressure: MilliBar = 154_000, 20_000..=350_000, Machine;
        /// Pump pressure this close to the relief setting means that the compensator has no margin left: 1 % of the setting, ten times the sensor's noise.
        relief_margin: MilliBar = 1_500, 100..=20_000, Machine;
    }
}

parameter_group! {
    /// Plausible values of the sensors.
    SensorParameters, "sensors" {
        /// Smallest rocker angle that a healthy sensor shows: the lower end less mounting error.
        angle_min: MilliDegree = 40_000, -360_000..=360_000, UP;
        /// Largest rocker angle that a healthy sensor shows: the upper end plus mounting error.
        angle_max: MilliDegree = 140_000, -360_000..=360_000, DOWN;
        /// Largest change in one step: the fastest drop is 0.2 degree, the rest is ten sigma of noise. At most 5 degrees, which a jump may hide.
        angle_jump: MilliDegree = 1_000, 100..=5_000, DOWN;
        /// Smallest lever position that a healthy lever shows: below it the wire is broken.
        lever_min: MilliDegree = 30_000, -360_000..=360_000, UP;
        /// Largest lever position that a healthy lever shows: above it the wire is shorted.
        lever_max: MilliDegree = 150_000, -360_000..=360_000, DOWN;
        /// Smallest pressure that a healthy sensor shows: zero less offset.
        pressure_min: MilliBar = -5_000, -50_000..=0, UP;
        /// Largest pressure that a healthy sensor shows: shock valve plus margin.
        pressure_max: MilliBar = 260_000, 20_000..=600_000, DOWN;
        /// How long a bad angle or lever sample is bridged by the last good one before it is a fault: at full speed the hitch moves less than 1 degree. At most 44 ms: the fastest lowering of 112 degrees a second goes 5 degrees.
        bridged: Millisecond = 5, 0..=44, DOWN;
        /// Time constant with which the angle sensor and its filter follow the hitch. An error to the long side costs time, one to the short side overshoot. A frozen angle is found later by it, so that some of the range is refused; see `docs/safety.md`.
        angle_lag: Millisecond = 0, 0..=500, DOWN;
        /// 1 if the angle sensor has a second, inverted track: then it has to agree with the first.
        second_track: Count = 0, 0..=1, UP;
    }
}

parameter_group! {
    /// The start-up lock.
    LockParameters, "lock" {
        /// The lever has to come this close to the hitch, or past it: 1 % of the range.
        pick_up_window: MilliDegree = 1_000, 100..=5_000, DOWN;
        /// ... and to have moved this far: 0.8 % of the range, beyond lever noise.
        lever_movement: MilliDegree = 730, 100..=10_000, UP;
        /// ... within this time: a lever that creeps at less than 3.7 degrees a second is not moved by a hand.
        lever_time: Millisecond = 200, 50..=10_000, DOWN;
        /// How long everything has to be healthy before a fault gives way to the lock.
        healthy_time: Millisecond = 500, 10..=60_000, UP;
        /// Engine speed up to which the lock stays shut: a starter turns the engine slower, and shakes lever and supply.
        engine_running: RevolutionPerMinute = 400, 0..=2_000, UP;
        /// ... and for this long after the engine has come up: until its supply has settled.
        engine_settling: Millisecond = 500, 0..=10_000, UP;
        /// 1 if the hitch is locked while no engine speed is known. With 0, a machine that has never told its engine speed since power-up isn't locked for it; one that has told it and falls silent is.
        engine_required: Count = 0, 0..=1, UP;
    }
}

parameter_group! {
    /// What the operator sets besides the lever.
    OperatorParameters, "operator" {
        /// Lowering-rate dial below which nothing is lowered: the dial's shut end with room for its tolerance.
        dial_shut: PerMille = 140, 0..=450, UP;
        /// Lowering speed with the dial in the middle, as delivered: 158 mm in 2.1 s, since full lowering shouldn't take less than 2 s.
        dial_middle_speed: MicrometrePerSecond = 75_000, 1_000..=1_000_000, Machine;
        /// Dial from which lowering is as fast as `position.lower_speed`: the dial's open end with room for its tolerance.
        dial_open: PerMille = 960, 550..=1_000, Machine;
        /// Where quick lift goes: 88 % of the range, short of the upper end so that a drive shaft is not bent.
        quick_lift_angle: MilliDegree = 124_900, -360_000..=360_000, Machine;
        /// Lever at or below which a hitch that has come down floats: the lever's bottom stop, 0.1 degree above the lowest set point.
        float_lever: MilliDegree = 44_700, -360_000..=360_000, Machine;
        /// ... if the hitch is below this: 6 % of the range.
        float_angle: MilliDegree = 49_600, -360_000..=360_000, Machine;
        /// Lever from which floating ends: 0.8 % of the range beyond where it begins, clear of lever noise.
        float_exit: MilliDegree = 45_450, -360_000..=360_000, Machine;
        /// ... and for how long: a knock on the lever does not count.
        float_exit_time: Millisecond = 200, 0..=5_000, Machine;
        /// 1: each external button has a second contact, which opens when it is pressed. A press and a release then need both contacts to say so.
        second_contact: Count = 0, 0..=1, UP;
    }
}

parameter_group! {
    /// The motion estimator.
    MotionParameters, "motion" {
        /// Time constant of the position estimate: averages the angle noise to a sixth, and stays below the load's own frequency.
        position_time: Millisecond = 30, 1..=500, Machine;
        /// The same while lowering, where load and oil make the map more wrong than the swing does.
        lowering_time: Millisecond = 17, 1..=500, Machine;
        /// By how much a hitch trails its lift valve beyond the lag of its spool: its load has to be accelerated on its oil.
        lift_trail: Microsecond = 6_500, 0..=100_000, Machine;
        /// The same of the lowering valve: oil, friction and the load's own fall.
        lowering_trail: Microsecond = 11_500, 0..=100_000, Machine;
        /// Furthest that a machine's spools may be slower or faster than the calibration says.
        lag_limit: Millisecond = 30, 0..=200, Machine;
        /// Lag of the lift valve beyond the lowering valve's from which the load swings on a compensator that lags: valves of one machine, one of them off its curve, seem to differ by up to 12 ms.
        swing_lag: Millisecond = 14, 0..=200, Machine;
        /// Largest error of the valve map that the estimator may blame on it: 0.25 A of threshold at 15 bar is 34 mm/s.
        bias_limit: MicrometrePerSecond = 80_000, 0..=500_000, Machine;
    }
}

parameter_group! {
    /// Position control.
    PositionParameters, "position" {
        /// Lowest set point that is obeyed: half a degree above the mechanical end, so that the hitch does not push against the end stop. Changed at rest only; the hitch is then locked until the lever is moved through it.
        lower_limit: MilliDegree = 44_600, -360_000..=360_000, UP;
        /// Highest set point that is obeyed: half a degree below the mechanical end. Changed at rest only.
        upper_limit: MilliDegree = 135_400, -360_000..=360_000, DOWN;
        /// A resting hitch follows the lever only when it moves by more than this: 0.2 % of the range, beyond lever noise. A change takes effect with the next movement of the lever.
        lever_deadband: MilliDegree = 200, 0..=5_000, Live;
        /// The coil is cut when that would bring the hitch this close: 0.1 degree short, so that a load swings about a place with room beyond.
        stop_band: Micrometre = 170, 0..=5_000, Live;
        /// A resting hitch that is further off than this is corrected: 0.35 degree, inside the 0.5 degree that is asked for. A change takes effect with the next movement of the lever.
        restart_band: Micrometre = 600, 20..=10_000, Live;
        /// Speed per remaining distance at the end of the approach: 10 Hz, about the frequency at which a load swings on its oil, which is damped while it is lifted.
        approach_gain: PerSecond = 60, 1..=200, Live;
        /// Slowest approach: cutting the coil at this speed swings a load on oil with air in it, 5 Hz, by 0.07 degree. Corrections are three times as fast.
        creep_speed: MicrometrePerSecond = 3_700, 0..=100_000, Live;
        /// Fastest lifting: beyond the valve's saturation, so it doesn't limit.
        lift_speed: MicrometrePerSecond = 150_000, 1_000..=1_000_000, Live;
        /// Fastest lowering, and the only limit of a machine without a dial: 250 kg through the fully open valve. That full lowering takes 2 s is asked of a dial as delivered; a machine that has none and shall keep to it gets 75 mm/s here.
        lower_speed: MicrometrePerSecond = 300_000, 1_000..=1_000_000, Live;
        /// Acceleration when lifting: full speed in 40 ms, which the lag of the spool rounds to the edge of a normal manoeuvre.
        lift_acceleration: MillimetrePerSecondSquared = 3_800, 50..=20_000, Live;
        /// Deceleration when lifting: full speed in 210 ms; a gravity-loaded piston would bounce from 3 m/s2 on at light load, and the time lost against it is little.
        lift_deceleration: MillimetrePerSecondSquared = 700, 50..=20_000, Live;
        /// Acceleration when lifting a load that swings on its compensator: full speed in 280 ms, most of a period behind the open valve.
        swinging_acceleration: MillimetrePerSecondSquared = 540, 50..=20_000, Live;
        /// Deceleration when lifting a load that swings on its compensator: full speed in half a second, an eighth of what gravity alone could do.
        swinging_deceleration: MillimetrePerSecondSquared = 290, 50..=20_000, Live;
        /// Acceleration when lowering, at the reference drop; it goes with the speed that the load gives. 250 kg keep half of their pressure.
        lower_acceleration: MillimetrePerSecondSquared = 3_200, 50..=20_000, Live;
        /// Deceleration when lowering, at the reference drop: what stops 250 kg adds half of their pressure, and thick oil still lets the estimate follow.
        lower_deceleration: MillimetrePerSecondSquared = 850, 50..=20_000, Live;
        /// Deceleration when a move is called off or reversed: twice the ramp, as the operator wants another motion.
        abort_deceleration: MillimetrePerSecondSquared = 3_000, 50..=20_000, Live;
    }
}

parameter_group! {
    /// Rate control (hold-to-run buttons).
    RateParameters, "rate" {
        /// Fastest speed that may be asked for: a person stands beside the implement. At most 25 degrees a second: a hand that lets go within 0.2 s stops it after 5 degrees. Changed at rest only.
        rate_limit: MilliDegreePerSecond = 15_000, 100..=25_000, DOWN;
        /// Longest travel of one press, after which the button has to be released: a wire that is shorted to ground moves the hitch no further. At most the default, a third of the travel.
        longest_travel: MilliDegree = 30_000, 5_000..=30_000, DOWN;
        /// Ramp of the rocker speed: full speed in half a second, so that the operator can still release it.
        rate_slope: MilliDegreePerSecond = 30_000, 1_000..=1_000_000, Live;
        /// Time of the integral on what is left of the speed's error: slower than estimate and spool together.
        trim_time: Millisecond = 250, 20..=10_000, Live;
        /// Most that it takes off or adds: what 0.1 A are on the steep part of the lowering valve's curve.
        trim_limit: MicrometrePerSecond = 14_000, 0..=200_000, Live;
    }
}

parameter_group! {
    /// Check-valve logic: resting on the check valve.
    HoldParameters, "hold" {
        /// Both coils stay off this long between two moves: the check valve seats, the spool centres, the pressure settles.
        dwell: Millisecond = 150, 20..=2_000, Machine;
        /// Time constant of the resting position: slow against noise and swinging, fast against a leak.
        rest_time: Millisecond = 250, 1..=5_000, Machine;
        /// How often a hitch that left its place by itself is brought back before that is a fault.
        corrections: Count = 5, 0..=100, DOWN;
        /// How far a hitch that leaves its place by itself is brought back, all corrections together: each rightful one is less than 1 degree. At most 9.6 mm, 5 degrees.
        corrected_travel: Micrometre = 4_500, 500..=9_600, DOWN;
        /// A correction is forgotten after this time: a seated valve sinks less in it than a correction makes good, 0.25 degree.
        correction_memory: Millisecond = 740_000, 1_000..=86_400_000, Machine;
    }
}

parameter_group! {
    /// Compensator logic: flow that is missing.
    SaturationParameters, "saturation" {
        /// Window over which demanded and measured travel are compared.
        window: Millisecond = 400, 50..=5_000, Machine;
        /// Demanded travel in a window from which a comparison says something: twenty times the noise of its measurement.
        demanded_travel: Micrometre = 3_000, 200..=100_000, Machine;
        /// Pump pressure has to stay near the relief valve this long: longer than the swing at the start of a lift.
        relief_time: Millisecond = 60, 5..=2_000, Machine;
        /// Rest after a stall before the next attempt.
        retry_time: Millisecond = 1_500, 100..=60_000, Machine;
        /// Attempts before a hitch that doesn't move is a fault.
        attempts: Count = 3, 1..=100, Machine;
    }
}

parameter_group! {
    /// Teaching thresholds and ends.
    TeachParameters, "teach" {
        /// Rest before each ramp: a load has swung out, and the angle's average has settled.
        rest_time: Millisecond = 600, 50..=10_000, Machine;
        /// Average of the angle: takes its noise to a sixth.
        filter_time: Millisecond = 16, 1..=500, Machine;
        /// Where a ramp begins: below the lowest threshold of this kind of valve.
        ramp_start: MilliAmp = 600, 0..=5_000, Machine;
        /// How fast it rises: by the curve the hitch is at 4 mm/s when it has moved by `moved`.
        ramp_slope: MilliAmpPerSecond = 400, 10..=10_000, Machine;
        /// Where it ends without a result: beyond the highest threshold, where the valve is a quarter open.
        ramp_end: MilliAmp = 2_000, 100..=5_000, Machine;
        /// What counts as moved: 0.17 degree, twenty times what is left of the noise.
        moved: Micrometre = 300, 20..=10_000, Machine;
        /// Furthest that a threshold may be off the curve: valves of one kind differ by 0.1 A, and contacts age.
        most_shift: MilliAmp = 300, 10..=1_000, Machine;
        /// Furthest that the ramps of one valve may be apart: what its friction leaves uncertain.
        most_spread: MilliAmp = 30, 2..=500, Machine;
        /// Current above the threshold on the way up to the end: 17 mm/s, slow enough for an end stop.
        lift_excess: MilliAmp = 250, 20..=2_000, Machine;
        /// Current above the threshold on the way down: the same, beyond the metering notch.
        lower_excess: MilliAmp = 620, 20..=2_000, Machine;
        /// A hitch that hasn't moved for this long is at an end.
        look_time: Millisecond = 300, 50..=5_000, Machine;
        /// Longest way to an end.
        longest_drive: Millisecond = 60_000, 1_000..=600_000, Machine;
        /// Stroke of the cylinder, from end to end.
        stroke: Micrometre = 158_000, 10_000..=2_000_000, Machine;
        /// How far the sensor may be turned against the linkage: beyond it the sensor is mounted a tooth off. At most 5 degrees, by which the limits then are wrong.
        most_offset: MilliDegree = 3_000, 100..=5_000, DOWN;
        /// How far the travel may differ from what the linkage allows: an obstacle, or another linkage. At most 5 degrees, by which the limits then are wrong.
        most_stretch: MilliDegree = 1_500, 100..=5_000, DOWN;
        /// Set points stay this far inside the ends, so that the hitch does not push against the end stops.
        end_margin: MilliDegree = 500, 0..=10_000, UP;
    }
}

parameter_group! {
    /// Regulating the coils' currents.
    CurrentParameters, "current" {
        /// Resistance of a coil at 20 C with wiring and driver, where the estimate starts.
        nominal_resistance: MilliOhm = 2_300, 500..=20_000, Machine;
        /// Lowest resistance that the estimate may take: a coil at -40 C, less the spread of new ones.
        lowest_resistance: MilliOhm = 1_500, 100..=20_000, Machine;
        /// Highest: a coil at 120 C.
        highest_resistance: MilliOhm = 3_300, 500..=50_000, Machine;
        /// How fast the estimate follows: 30 % of a coil within its first fifth of a second; a step is 0.1 % of it.
        adaptation: MilliOhmPerSecond = 3_000, 0..=10_000, Machine;
        /// Time after a change of the request before the estimate learns: four time constants of a coil.
        settling_time: Millisecond = 30, 1..=1_000, Machine;
        /// Voltage for each ampere that is missing: closes the gap in three steps of 1 ms on 12 mH.
        proportional: MilliOhm = 5_000, 0..=50_000, Machine;
        /// The same for each step that it has been missing: cancels the coil's own time constant of 5 ms.
        integral: MilliOhm = 1_000, 0..=20_000, Machine;
        /// Drop over the diode through which the current flows on while the driver is off.
        freewheel_drop: MilliVolt = 700, 0..=2_000, Machine;
        /// Supply where it isn't measured: a running alternator.
        assumed_supply: MilliVolt = 13_500, 6_000..=36_000, Machine;
        /// Amplitude of the dither: 3 % of the largest current, which halves the hysteresis of a spool on plain current.
        dither_amplitude: MilliAmp = 100, 0..=400, Machine;
        /// Period of the dither: 125 Hz, above the band of a spool and below that of a coil.
        dither_period: Millisecond = 8, 4..=20, Machine;
    }
}

parameter_group! {
    /// What is sent on the bus, and from whom it is received.
    BusParameters, "bus" {
        /// How often loggers are sent currents, angle and pressures; 0 is never. 50 Hz are what a campaign has, and take 6 % of a bus of 250 kbit/s.
        measured_period: Millisecond = 20, 0..=1_000, Live;
        /// Source address whose engine speed is accepted: that of the first engine. Changed at rest only.
        engine_address: Count = 0, 0..=253, KEY_ONLY;
        /// Another one: that of the second engine, or of a unit that forwards the speed. Changed at rest only.
        second_engine_address: Count = 1, 0..=253, KEY_ONLY;
    }
}

parameter_group! {
    /// Remote control by an implement.
    RemoteParameters, "remote" {
        /// How the operator consents to it: 0 not at all, it is refused; 1 with the consent contact; 2 with the lever, moved there and back twice. An input without a contact reads as open, which is no consent.
        consent: Count = 1, 0..=2, KEY_ONLY;
        /// Lowest position that an implement may ask for, 0 is the lower limit of the travel: all of it, since working depth is what implements control.
        lowest: PerMille = 0, 0..=1_000, UP;
        /// Highest position that an implement may ask for, 1000 is the upper limit of the travel: 88 %, that of quick lift, short of the upper end so that a drive shaft isn't bent.
        highest: PerMille = 880, 0..=1_000, DOWN;
        /// Largest piston speed on the set point of an implement, both ways: half of what the valve gives when lifting, the full travel in 2.1 s. No hand is on the lever, and a bystander has the time to step back.
        speed: MicrometrePerSecond = 75_000, 1_000..=1_000_000, DOWN;
        /// Ground speed above which remote control ends and is refused, if a node tells the speed: 15 km/h, faster than any work with an implement that commands its hitch.
        ground_speed: MicrometrePerSecond = 4_167_000, 0..=60_000_000, DOWN;
    }
}

parameter_group! {
    /// The safety envelope.
    SafetyParameters, "safety" {
        /// Largest current of the lift coil: what the coil bears.
        lift_current_limit: MilliAmp = 3_500, 100..=5_000, DOWN;
        /// Largest current of the lowering coil: what the coil bears.
        lower_current_limit: MilliAmp = 3_500, 100..=5_000, DOWN;
        /// A current may start at once up to here: below and just above the threshold nothing moves yet. Full flow at once instead of in 50 ms is 2.8 degrees more at 112 degrees a second.
        free_current: MilliAmp = 1_500, 0..=5_000, DOWN;
        /// Above it currents rise no faster than this: full flow in 50 ms at the earliest. Falling is always free. Full flow at once instead of in 50 ms is 2.8 degrees more at 112 degrees a second.
        current_slope: AmperePerSecond = 40, 1..=10_000, DOWN;
        /// How far the lever has to move since power-up or the last trip before any coil is switched on: half of what opens the lock, clear of noise.
        arming_movement: MilliDegree = 350, 50..=5_000, UP;
        /// Age at which a command is stale and both coils go off for good: at full speed the hitch moves less than 1 degree. At most 44 ms: the fastest lowering of 112 degrees a second goes 5 degrees.
        command_age: Millisecond = 5, 1..=44, DOWN;
        /// How long a signal has to be missing, out of range or jumping: the same. At most 44 ms: the fastest lowering of 112 degrees a second goes 5 degrees.
        sensor_time: Millisecond = 5, 1..=44, DOWN;
        /// A step that begins later than this after the last is an overrun: half a step of slack. At most 22 ms, with `overrun_time` 44 ms: 5 degrees at 112 degrees a second.
        longest_step: Microsecond = 1_500, 1_000..=22_000, DOWN;
        /// A step that begins sooner than this after the last is one as well: half a step of slack.
        shortest_step: Microsecond = 500, 0..=999, UP;
        /// How long steps have to be late or early: one may be, for a flash page that is written. At most 22 ms, with `longest_step` 44 ms: 5 degrees at 112 degrees a second.
        overrun_time: Millisecond = 2, 1..=22, DOWN;
        /// Lowest supply voltage: below it the largest current no longer fits through a hot coil, and converters lose their reference.
        supply_min: MilliVolt = 8_000, 5_000..=24_000, UP;
        /// Highest supply voltage: a charging fault, or a start with a 24 V supply.
        supply_max: MilliVolt = 16_800, 9_000..=36_000, DOWN;
        /// How long the supply has to be wrong: longer than the swing as a relay switches, and at full speed less than 2 degrees. At most 44 ms: the fastest lowering of 112 degrees a second goes 5 degrees.
        supply_time: Millisecond = 10, 1..=44, DOWN;
        /// A sample that has been the same to the last bit for this long when travel is missing is called frozen: eight throws of noise. At most 44 ms: the fastest lowering of 112 degrees a second goes 5 degrees.
        frozen_time: Millisecond = 8, 2..=44, DOWN;
        /// A sensor that shows noise at rest is frozen once it is still for this long: a healthy one is by chance once in a million years. At most 44 ms: the fastest lowering of 112 degrees a second goes 5 degrees.
        still_time: Millisecond = 20, 5..=44, DOWN;
        /// Mean second difference from which a sensor is too noisy: six times that of a healthy one, whose sigma of 0.05 degree gives 0.1 degree. At most 5 degrees, which noise may hide.
        noise_limit: MilliDegree = 600, 50..=5_000, DOWN;
        /// Current above the threshold that may do nothing in a hitch that starts: 0.1 A that a threshold is off, and half of 0.2 A of hysteresis. Half of it in one that moves. At most 0.3 A: by the curves a lifting hitch then owes nothing up to 10 degrees a second, 5 degrees in half a second.
        following_margin: MilliAmp = 200, 0..=300, DOWN;
        /// Each of the two lags behind which a hitch in motion follows a rising current: together a slow spool. At most 22 ms, both 44 ms: 5 degrees at 112 degrees a second.
        following_lag: Millisecond = 20, 1..=22, DOWN;
        /// Each of the two lags behind which a hitch follows its current that has just started: the first motion is seen before a slow spool is open. At most the default: both are 9 degrees at 112 degrees a second.
        started_lag: Millisecond = 40, 1..=40, DOWN;
        /// Lift speed by the valve curve that the current is limited to when the onset budget is spent: a hitch on the ground still starts with it. At most 48 mm/s: 5 degrees in 0.2 s, at 1.92 mm a degree.
        lift_onset_speed: MicrometrePerSecond = 20_000, 1_000..=48_000, DOWN;
        /// The same of lowering. At most 48 mm/s: 5 degrees in 0.2 s, at 1.92 mm a degree.
        lower_onset_speed: MicrometrePerSecond = 15_000, 1_000..=48_000, DOWN;
        /// Travel that a hitch is given by the valve curve before motion has been seen and its current is limited. A healthy one is given about 3 degrees by the controller's ramp, one that is heavy, late and off by 0.1 A more than 5: less than 8 makes such moves overshoot. At most the default, which is more than 5 degrees already.
        onset_budget: MilliDegree = 8_000, 0..=8_000, DOWN;
        /// Time constant with which the rest of the budget may be given, so that the current falls back smoothly.
        onset_time: Millisecond = 25, 1..=1_000, KEY_ONLY;
        /// Travel along the coil's way that is motion, on top of the sensor's mean second difference: five sigmas of averaged noise of 0.05 degree. At most 5 degrees, which are not seen as motion.
        onset_travel: MilliDegree = 100, 0..=5_000, KEY_ONLY;
        /// Travel given by currents above threshold and margin after which a hitch that shows no motion is a fault: what the budget and 0.2 s of the onset speed give. At most the default, which is more than 5 degrees already.
        onset_debt: MilliDegree = 10_000, 10..=10_000, DOWN;
        /// As much again for a hitch that is lifted off its lower end stop, which carried its load: the oil is compressed from no pressure at all, for up to 0.15 s longer. At most 5 degrees.
        stop_debt: MilliDegree = 1_500, 0..=5_000, DOWN;
        /// Share of the calibration's speed that a hitch in motion owes: healthy ones that swing, or take up a load from the ground, stand while they are given 12 mm of piston travel. At least the default: with `following_allowance`, 12.5 mm or 6.5 degrees are given before a standstill is a fault.
        following_share: PerMille = 80, 80..=1_000, UP;
        /// Speed that a hitch in motion owes if the calibration gives twice as much or more: a standstill of 125 ms is then a fault, of healthy ones that swing the longest took 98 ms. At least the default: 14 degrees at the fastest lowering.
        following_speed: MicrometrePerSecond = 8_000, 8_000..=1_000_000, UP;
        /// Travel that is owed when a standstill is a fault, 0.5 degree; a quarter of it, five sigmas of averaged noise of 0.1 degree, is motion. At most the default: with `following_speed`, 14 degrees at the fastest lowering.
        following_allowance: Micrometre = 1_000, 50..=1_000, DOWN;
        /// Within this of the ends no travel towards them is owed: the end stop itself, of a sensor that is turned by as much as teaching accepts. At most 5 degrees, in which a standstill is no fault.
        end_zone: MilliDegree = 4_000, 0..=5_000, DOWN;
        /// Movement against the energised coil that trips: above noise and the swing at a start. At most 5 degrees, which are the extra travel.
        contradiction: MilliDegree = 4_000, 500..=5_000, DOWN;
        /// How far beyond a limit of its travel the hitch may be while a current drives it further: a load that swings about its set point, and the noise of the dial. At most 5 degrees, which are the extra travel.
        limit_margin: MilliDegree = 2_000, 0..=5_000, DOWN;
        /// How long such a current, or one that lowers with the dial shut, may flow: `position.abort_deceleration` stops the fastest lowering of 216 mm/s in 72 ms. At most the default: 11 degrees at 112 degrees a second without a ramp.
        limit_time: Millisecond = 100, 1..=100, DOWN;
        /// Current from which a broken wire can be told. At most 0.9 A, from which no valve of this kind opens: no extra travel.
        testable_current: MilliAmp = 500, 50..=900, DOWN;
        /// How long less than half of it has to flow: four time constants of a coil. At most 44 ms: the fastest lowering of 112 degrees a second goes 5 degrees.
        open_time: Millisecond = 40, 2..=44, DOWN;
        /// Current beyond what was asked for that means a short: twice what a controller overshoots. At most 0.9 A: where nothing is asked for, no valve of this kind opens with it.
        excess_current: MilliAmp = 500, 50..=900, DOWN;
        /// How long: longer than a supply step takes to be regulated away, shorter than the spool needs to follow. At most 44 ms: the fastest lowering of 112 degrees a second goes 5 degrees.
        short_time: Millisecond = 8, 1..=44, DOWN;
        /// Current that may be left in a coil that is off. At most 0.9 A, from which no valve of this kind opens: no extra travel.
        leftover_current: MilliAmp = 200, 20..=900, DOWN;
        /// How long a coil may take to lose its current before that counts: six time constants with a freewheeling diode. At most 44 ms: the fastest lowering of 112 degrees a second goes 5 degrees.
        decay_time: Millisecond = 30, 2..=44, DOWN;
        /// Largest error of the converters' reference by the band gap. A healthy one shows up to 4.5 %: 2.5 % of the band gap and 2 % of a regulator. Currents and voltages are corrected for it, so their own error stays at the 2.5 %.
        reference_error: PerMille = 60, 10..=200, DOWN;
        /// How long the reference has to be off: its readings are corrected at once; one conversion that is disturbed by an edge of a pulse is no fault. At most 44 ms: the fastest lowering of 112 degrees a second goes 5 degrees.
        reference_time: Millisecond = 20, 1..=44, DOWN;
        /// Lowest supply of the sensors: 5 % below 5 V, the limit of the sensors' own data.
        sensor_supply_min: MilliVolt = 4_750, 1_000..=30_000, UP;
        /// Highest supply of the sensors: 5 % above 5 V.
        sensor_supply_max: MilliVolt = 5_250, 1_000..=30_000, DOWN;
        /// How long the supply of the sensors has to be wrong: shorter than `sensor_time`, since every sensor's signal goes with it and it is the cause to report. At most 44 ms: the fastest lowering of 112 degrees a second goes 5 degrees.
        sensor_supply_time: Millisecond = 4, 1..=44, DOWN;
        /// Largest difference between the tracks of the angle sensor: 1.4 degrees of tolerance, 1 % of the supply over 80 % for 110 degrees, and six sigma of the difference's noise, 0.07 degree. At most 5 degrees, which are the extra travel.
        track_difference: MilliDegree = 2_000, 200..=5_000, DOWN;
        /// How long the tracks have to disagree: as long as a sample may be missing.
        track_time: Millisecond = 5, 1..=20, DOWN;
        /// Largest change of the main clock by the independent oscillator since the start: that oscillator goes from 29.5 to 34 kHz over temperature and supply, 15 %; a clock that fails is off by half or more. At most 30 %: a ramp of 44 ms and 5 degrees then takes 13 ms or 1.5 degrees more.
        clock_error: PerMille = 200, 20..=300, DOWN;
        /// How long the clock has to be off: the step's own clock sees a wrong pace sooner, and this one finds both wrong together. At most 44 ms: the fastest lowering of 112 degrees a second goes 5 degrees.
        clock_time: Millisecond = 20, 1..=44, DOWN;
    }
}
