//! The portable drivers of coils and contacts, on mock pins: order and values of what is written, and failing pins.

use std::cell::RefCell;
use std::rc::Rc;

use embedded_hal::digital::{ErrorType, OutputPin};
use embedded_hal::pwm::{self, SetDutyCycle};
use embedded_hal_mock::eh1::MockError;
use embedded_hal_mock::eh1::digital::{Mock as Digital, State, Transaction as Level};
use embedded_hal_mock::eh1::pwm::{Mock as Pwm, Transaction as Duty};
use hitch_ecu::{CoilDriver, CoilDriverError, Compare, Contact, Drive, Panel, PanelInputs};
use hitch_quantities::units;

/// Names of the outputs in the order in which they were written.
type Log = Rc<RefCell<Vec<&'static str>>>;

/// A mock output that also notes when it was written.
struct Noted<T> {
    name: &'static str,
    log: Log,
    output: T,
}

impl ErrorType for Noted<Digital> {
    type Error = MockError;
}

impl OutputPin for Noted<Digital> {
    fn set_low(&mut self) -> Result<(), MockError> {
        self.log.borrow_mut().push(self.name);
        self.output.set_low()
    }

    fn set_high(&mut self) -> Result<(), MockError> {
        self.log.borrow_mut().push(self.name);
        self.output.set_high()
    }
}

impl pwm::ErrorType for Noted<Pwm> {
    type Error = MockError;
}

impl SetDutyCycle for Noted<Pwm> {
    fn max_duty_cycle(&self) -> u16 {
        5_250
    }

    fn set_duty_cycle(&mut self, duty: u16) -> Result<(), MockError> {
        self.log.borrow_mut().push(self.name);
        self.output.set_duty_cycle(duty)
    }
}

type Driver = CoilDriver<Noted<Pwm>, Noted<Pwm>, Noted<Digital>, Digital>;

fn failing(duty: Duty) -> Duty {
    duty.with_error(MockError::Io(std::io::ErrorKind::Other))
}

fn broken(level: Level) -> Level {
    level.with_error(MockError::Io(std::io::ErrorKind::Other))
}

/// A driver whose outputs expect these values.
fn driver(lift: &[Duty], lower: &[Duty], line: &[Level], feedback: &[Level]) -> (Driver, Log) {
    let log = Log::default();
    let pwm = |name, duties| Noted {
        name,
        log: log.clone(),
        output: Pwm::new(duties),
    };
    let line = Noted {
        name: "line",
        log: log.clone(),
        output: Digital::new(line),
    };
    let driver = CoilDriver::new(
        pwm("lift", lift),
        pwm("lower", lower),
        line,
        Digital::new(feedback),
    );
    (driver, log)
}

/// Everything that was expected has been written.
fn done(driver: Driver) {
    let (mut lift, mut lower, mut line, mut feedback) = driver.release();
    lift.output.done();
    lower.output.done();
    line.output.done();
    feedback.done();
}

fn lifting() -> Drive {
    Drive {
        lift: Compare::of(units::Duty(40_000), 5_250),
        lower: Compare::OFF,
        enable: true,
    }
}

fn low() -> Level {
    Level::set(State::Low)
}

fn high() -> Level {
    Level::set(State::High)
}

#[test]
fn pulses_are_set_before_the_line_rises_and_the_line_drops_before_them() {
    let (mut driver, log) = driver(
        &[Duty::set_duty_cycle(2_100), Duty::set_duty_cycle(0)],
        &[Duty::set_duty_cycle(0), Duty::set_duty_cycle(0)],
        &[high(), low()],
        &[],
    );
    assert_eq!(driver.drive(lifting()), Ok(()));
    assert_eq!(log.take(), ["lift", "lower", "line"]);
    assert_eq!(driver.drive(Drive::OFF), Ok(()));
    assert_eq!(log.take(), ["line", "lift", "lower"]);
    done(driver);
}

#[test]
fn pulses_without_the_line_are_not_passed_on() {
    let (mut driver, _) = driver(
        &[Duty::set_duty_cycle(0)],
        &[Duty::set_duty_cycle(0)],
        &[low()],
        &[],
    );
    let without_line = Drive {
        enable: false,
        ..lifting()
    };
    assert_eq!(driver.drive(without_line), Ok(()));
    done(driver);
}

#[test]
fn a_pulse_output_that_fails_cuts_both_coils_until_restart() {
    let zero = Duty::set_duty_cycle(0);
    for lift_fails in [true, false] {
        let (lift, lower) = (Duty::set_duty_cycle(2_100), zero.clone());
        let (lift, lower) = if lift_fails {
            (failing(lift), lower)
        } else {
            (lift, failing(lower))
        };
        let (mut driver, log) = driver(
            &[lift, zero.clone(), zero.clone()],
            &[lower, zero.clone(), zero.clone()],
            &[low(), low()],
            &[],
        );
        assert_eq!(driver.drive(lifting()), Err(CoilDriverError));
        assert_eq!(log.take(), ["lift", "lower", "line", "lift", "lower"]);
        // The line never rises again.
        assert_eq!(driver.drive(lifting()), Err(CoilDriverError));
        assert_eq!(log.take(), ["line", "lift", "lower"]);
        done(driver);
    }
}

#[test]
fn a_line_that_cannot_be_written_does_not_keep_the_pulses_from_zero() {
    for rises in [true, false] {
        let zero = Duty::set_duty_cycle(0);
        let pulses = [Duty::set_duty_cycle(2_100), zero.clone()];
        let lift = if rises { &pulses[..] } else { &pulses[1..] };
        let lower = vec![zero; lift.len()];
        let line = if rises {
            vec![broken(high()), broken(low())]
        } else {
            vec![broken(low())]
        };
        let (mut driver, _) = driver(lift, &lower, &line, &[]);
        let drive = if rises { lifting() } else { Drive::OFF };
        assert_eq!(driver.drive(drive), Err(CoilDriverError));
        done(driver);
    }
}

#[test]
fn a_read_back_that_fails_differs_from_what_was_asked_for() {
    let feedback = [
        Level::get(State::Low),
        broken(Level::get(State::Low)),
        Level::get(State::High),
        broken(Level::get(State::High)),
    ];
    let (mut driver, _) = driver(
        &[Duty::set_duty_cycle(2_100)],
        &[Duty::set_duty_cycle(0)],
        &[high()],
        &feedback,
    );
    assert_eq!(
        [driver.enable_feedback(), driver.enable_feedback()],
        [false, true]
    );
    assert_eq!(driver.drive(lifting()), Ok(()));
    assert_eq!(
        [driver.enable_feedback(), driver.enable_feedback()],
        [true, false]
    );
    done(driver);
}

#[test]
fn each_contact_closes_to_ground() {
    for (index, contact) in Panel::CONTACTS.into_iter().enumerate() {
        let mut levels = [State::High; Panel::CONTACTS.len()];
        levels[index] = State::Low;
        let mut inputs = PanelInputs::new(levels.map(|level| Digital::new(&[Level::get(level)])));
        assert_eq!(inputs.read(), Panel::default().with(contact, true));
        inputs.release().iter_mut().for_each(Digital::done);
    }
}

#[test]
fn a_contact_that_cannot_be_read_locks_the_hitch() {
    // Field mode is closed, and the contact behind it can't be read; those behind that are not asked any more.
    let mut levels: [&[Level]; Panel::CONTACTS.len()] = [&[]; _];
    let (high, low) = ([Level::get(State::High)], [Level::get(State::Low)]);
    let unreadable = [broken(Level::get(State::High))];
    levels[..4].copy_from_slice(&[&high, &high, &low, &unreadable]);
    let pins = levels.map(Digital::new);
    let mut inputs = PanelInputs::new(pins);
    let panel = inputs.read();
    assert!(!panel.is_closed(Contact::FieldMode));
    inputs.release().iter_mut().for_each(Digital::done);
}
