//! What holds for any inputs whatever.

use super::*;

/// Signals that stay, wander, jump, stop or go missing at random.
fn random_inputs(random: &mut Random, inputs: &mut Inputs) {
    fn changed<T>(
        random: &mut Random,
        value: &mut Option<T>,
        low: i32,
        high: i32,
        make: fn(i32) -> T,
    ) {
        match random.below(6_000) {
            0 => *value = None,
            1 => *value = Some(make(random.any())),
            2..=5 => *value = Some(make(low + random.below(high - low))),
            _ => {}
        }
    }
    changed(random, &mut inputs.lever, 40_000, 140_000, MilliDegree);
    changed(
        random,
        &mut inputs.rocker_angle,
        44_000,
        136_000,
        MilliDegree,
    );
    changed(random, &mut inputs.supply, 8_000, 16_000, MilliVolt);
    changed(random, &mut inputs.step_time, 900, 1_100, Microsecond);
    changed(random, &mut inputs.lift_current, 0, 3_500, MilliAmp);
    changed(random, &mut inputs.lower_current, 0, 3_500, MilliAmp);
    changed(
        random,
        &mut inputs.jog,
        -10_000,
        10_000,
        MilliDegreePerSecond,
    );
    if random.below(100) == 0 {
        inputs.lever = inputs
            .lever
            .map(|_| MilliDegree(40_000 + random.below(100_000)));
    }
    let wander = MilliDegree(random.below(101) - 50);
    inputs.rocker_angle = inputs.rocker_angle.map(|angle| angle + wander);
}

/// Xorshift: the same sequence everywhere.
struct Random(u64);

impl Random {
    fn any(&mut self) -> i32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 32) as i32
    }

    fn below(&mut self, limit: i32) -> i32 {
        self.any().rem_euclid(limit.max(1))
    }

    fn command(&mut self) -> Option<CoilCurrents> {
        let current =
            |random: &mut Self| [0, 0, random.below(4_000), random.any()][random.below(4) as usize];
        match self.below(400) {
            0 => None,
            1..=199 => Some(Order::Lift(self.below(3_500)).currents()),
            200..=398 => Some(Order::Lower(self.below(3_500)).currents()),
            _ => Some(CoilCurrents {
                lift: MilliAmp(current(self)),
                lower: MilliAmp(current(self)),
            }),
        }
    }
}

// REQ-SAFE-01
#[test]
fn whatever_happens_no_current_passes_that_must_not() {
    const SEQUENCES: u64 = 4_000;
    const STEPS: usize = 1_500;
    let mut on = 0_u64;
    for seed in 1..=SEQUENCES {
        let mut random = Random(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15));
        let (mut rig, mut last) = (Rig::new(), CoilCurrents::OFF);
        let mut inputs = rig.inputs();
        let first_lever = inputs.lever;
        let (mut touched, mut command) = (false, None);
        let (mut no_angle, mut no_lever) = (0, 0);
        for _ in 0..STEPS {
            random_inputs(&mut random, &mut inputs);
            if random.below(8) == 0 {
                command = random.command();
            }
            let was_tripped = rig.envelope.tripped().is_some();
            if seed % 8 == 0 {
                rig.envelope.claim_ride();
            }
            let passed = pass(&mut rig.envelope, command, &inputs, limits());
            touched |= inputs.lever != first_lever || inputs.jog.is_some();
            let both = passed.lift > MilliAmp(0) && passed.lower > MilliAmp(0);
            assert!(
                !both && passed.lift >= MilliAmp(0) && passed.lower >= MilliAmp(0),
                "seed {seed}: {passed:?}"
            );
            assert!(
                passed.lift <= SAFETY.lift_current_limit
                    && passed.lower <= SAFETY.lower_current_limit
            );
            let count = |missing: bool, count: i32| if missing { count + 1 } else { 0 };
            no_angle = count(inputs.rocker_angle.is_none(), no_angle);
            no_lever = count(inputs.lever.is_none(), no_lever);
            let sensed = no_angle < 5 && no_lever < 5;
            let may = command.is_some() && touched && rig.envelope.tripped().is_none() && sensed;
            assert!(
                may || passed == CoilCurrents::OFF,
                "seed {seed}: {passed:?} of {command:?} with {inputs:?}"
            );
            assert!(
                !was_tripped || rig.envelope.tripped().is_some(),
                "seed {seed}: cleared by itself"
            );
            let asked = command.unwrap_or_default();
            assert!(
                passed.lift <= asked.lift.max(MilliAmp(0))
                    && passed.lower <= asked.lower.max(MilliAmp(0))
            );
            let crossed =
                (last.lift.0 > 0 && passed.lower.0 > 0) || (last.lower.0 > 0 && passed.lift.0 > 0);
            assert!(!crossed, "seed {seed}: from {last:?} to {passed:?}");
            on += u64::from(passed != CoilCurrents::OFF);
            last = passed;
            if random.below(10) == 0 && was_tripped {
                rig.envelope.reset();
                if rig.envelope.tripped().is_none() && was_tripped {
                    touched = false;
                    inputs.jog = None;
                    // Armed anew by a movement from where the lever is now.
                    touched |= inputs.lever != first_lever;
                }
            }
        }
    }
    println!(
        "{} steps, a coil on in {on} of them",
        SEQUENCES * STEPS as u64
    );
    assert!(
        on > SEQUENCES * STEPS as u64 / 100,
        "coils on in {on} steps: too few to say anything"
    );
}

#[test]
fn whatever_went_before_a_command_that_stops_coming_cuts_at_once_and_trips_in_time() {
    const SEQUENCES: u64 = 4_000;
    let (mut from_lift, mut from_lower, mut from_rest) = (0, 0, 0);
    for seed in 1..=SEQUENCES {
        let mut random = Random(seed.wrapping_mul(0x2545_F491_4F6C_DD1D));
        // Half of them begin at full speed, the others anywhere.
        let mut rig = match random.below(4) {
            0 => Rig::moving(LIFT),
            1 => Rig::moving(LOWER),
            _ => Rig::armed(),
        };
        let mut inputs = rig.inputs();
        let mut command = Some(rig.passed);
        for _ in 0..random.below(300) {
            random_inputs(&mut random, &mut inputs);
            if random.below(8) == 0 {
                command = random.command();
            }
            rig.passed = pass(&mut rig.envelope, command, &inputs, limits());
        }
        let counter = match rig.passed {
            CoilCurrents::OFF => &mut from_rest,
            CoilCurrents { lift, .. } if lift > MilliAmp(0) => &mut from_lift,
            _ => &mut from_lower,
        };
        *counter += 1;
        for step in 1..=SAFETY.command_age.0 {
            random_inputs(&mut random, &mut inputs);
            let passed = pass(&mut rig.envelope, None, &inputs, limits());
            assert_eq!(passed, CoilCurrents::OFF, "seed {seed}, step {step}");
        }
        assert!(rig.envelope.tripped().is_some(), "seed {seed}: not in time");
        for _ in 0..50 {
            random_inputs(&mut random, &mut inputs);
            let passed = pass(&mut rig.envelope, random.command(), &inputs, limits());
            assert_eq!(
                passed,
                CoilCurrents::OFF,
                "seed {seed}: came back by itself"
            );
        }
    }
    println!("from lifting {from_lift}, lowering {from_lower}, both coils off {from_rest}");
    assert!(from_lift > 100 && from_lower > 100 && from_rest > 100);
}
