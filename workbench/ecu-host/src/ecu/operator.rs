//! The operator: lever, dials and switches, and the commands that move them.

use std::ops::RangeInclusive;

use hitch_ecu::{Contact, Panel};
use hitch_plant::Model;

use super::converters::SENSORS_DEG;

/// Time of the lever capture by the operator, ms: after the first address claim.
pub const PICK_UP_MS: u64 = 500;

/// Speed of a lever moved by hand, degrees per second.
const HAND_DEG_PER_S: f64 = 60.0;

/// Travel of the lever beyond both ends of the hitch's, degree.
const BEYOND_DEG: f64 = 10.0;

/// Range of lever and upper-limit dial of a machine on the scale of the rocker angle, in whole degrees: the travel of the
/// hitch and some degrees more, as far as the board's sensors measure it.
#[must_use]
pub fn reach_deg(model: &Model) -> RangeInclusive<f64> {
    let (low_rad, high_rad) = model.linkage().swing_rad();
    let low_deg = (low_rad.to_degrees() - BEYOND_DEG).ceil();
    let high_deg = (high_rad.to_degrees() + BEYOND_DEG).floor();
    low_deg.max(*SENSORS_DEG.start())..=high_deg.min(*SENSORS_DEG.end())
}

/// A command to the operator.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Order {
    /// Moves the lever to an angle, at hand speed.
    Lever(f64),
    /// Closes or opens a contact.
    Contact(Contact, bool),
    /// Presses or releases the external buttons up and down, each with both of its contacts.
    Buttons(bool, bool),
    /// Sets the upper-limit dial.
    UpperLimit(f64),
    /// Sets the lowering-rate dial, 0 to 1.
    LoweringDial(f64),
    /// Switches the power off and on.
    Power,
    /// Ends the program.
    Quit,
}

impl Order {
    /// The accepted commands.
    pub const WORDS: &'static str = "lever DEG, up, down, stop, quick on|off, hold on|off, lock on|off, \
        service on|off, consent on|off, limit DEG, dial PERCENT, power, quit";
}

impl Order {
    /// The command in a line; `reach_deg` is the range of lever and upper-limit dial, degree.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn parse(line: &str, reach_deg: &RangeInclusive<f64>) -> Result<Self, String> {
        let unknown = || {
            format!(
                "unknown command `{}`; commands: {}",
                line.trim(),
                Self::WORDS
            )
        };
        let words: Vec<&str> = line.split_whitespace().collect();
        let number = |text: &str, low: f64, high: f64| {
            text.parse()
                .ok()
                .filter(|value| (low..=high).contains(value))
                .ok_or_else(|| format!("`{text}` has to be a number from {low} to {high}"))
        };
        let switch = |text: &str| match text {
            "on" => Ok(true),
            "off" => Ok(false),
            _ => Err(unknown()),
        };
        Ok(match *words.as_slice() {
            ["lever", angle] => Self::Lever(number(angle, *reach_deg.start(), *reach_deg.end())?),
            ["limit", angle] => {
                Self::UpperLimit(number(angle, *reach_deg.start(), *reach_deg.end())?)
            }
            ["dial", percent] => Self::LoweringDial(number(percent, 0.0, 100.0)? / 100.0),
            ["up"] => Self::Buttons(true, false),
            ["down"] => Self::Buttons(false, true),
            ["stop"] => Self::Buttons(false, false),
            ["quick", position] => Self::Contact(Contact::QuickLift, switch(position)?),
            ["hold", position] => Self::Contact(Contact::Hold, switch(position)?),
            ["lock", position] => Self::Contact(Contact::FieldMode, !switch(position)?),
            ["consent", position] => Self::Contact(Contact::Consent, switch(position)?),
            ["service", position] => Self::Contact(Contact::Service, switch(position)?),
            ["power"] => Self::Power,
            ["quit"] => Self::Quit,
            _ => return Err(unknown()),
        })
    }
}

/// Positions of all controls.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Operator {
    /// Lever, degree on the scale of the rocker angle.
    pub lever_deg: f64,
    /// Target of the lever, degree.
    pub lever_target_deg: f64,
    /// Upper-limit dial, degree.
    pub upper_limit_deg: f64,
    /// Lowering-rate dial, 0 to 1.
    pub lowering_dial: f64,
    /// Buttons and switches.
    pub panel: Panel,
}

impl Operator {
    /// An operator in the field with the lever at `lever_deg`, and no limits set.
    pub const fn with_lever_at(lever_deg: f64) -> Self {
        Self {
            lever_deg,
            lever_target_deg: lever_deg,
            upper_limit_deg: *SENSORS_DEG.end(),
            lowering_dial: 1.0,
            panel: Panel::FIELD,
        }
    }

    /// Executes a command that concerns controls; power is handled elsewhere.
    pub fn apply(&mut self, order: Order) {
        match order {
            Order::Lever(angle_deg) => self.lever_target_deg = angle_deg,
            Order::Contact(contact, closed) => self.panel = self.panel.with(contact, closed),
            Order::Buttons(up, down) => self.panel = self.panel.with_buttons(up, down),
            Order::UpperLimit(angle_deg) => self.upper_limit_deg = angle_deg,
            Order::LoweringDial(share) => self.lowering_dial = share,
            Order::Power | Order::Quit => {}
        }
    }

    /// One millisecond: moves the lever towards its target.
    pub fn tick(&mut self) {
        let most_deg = HAND_DEG_PER_S * 1e-3;
        let missing_deg = self.lever_target_deg - self.lever_deg;
        self.lever_deg += missing_deg.clamp(-most_deg, most_deg);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orders_are_words() {
        let parse = |line| Order::parse(line, &(35.0..=145.0));
        assert_eq!(parse("lever 80"), Ok(Order::Lever(80.0)));
        assert_eq!(
            parse(" lock  on "),
            Ok(Order::Contact(Contact::FieldMode, false))
        );
        assert!(parse("lever 300").unwrap_err().contains("35 to 145"));
        assert!(parse("jump").unwrap_err().contains("lever DEG"));
    }

    #[test]
    fn the_lever_reaches_as_far_as_the_hitch_and_its_sensor() {
        let nominal = hitch_model_file::nominal();
        assert_eq!(reach_deg(&nominal), 35.0..=145.0);
        let mut constants = nominal.constants().clone();
        constants.cylinder.stroke_m = 0.1;
        let short = nominal.with_constants(constants).expect("a linkage");
        let (low_rad, high_rad) = short.linkage().swing_rad();
        let reach = reach_deg(&short);
        let beyond_deg = [
            low_rad.to_degrees() - reach.start(),
            reach.end() - high_rad.to_degrees(),
        ];
        assert!(
            beyond_deg
                .iter()
                .all(|beyond| (9.0..=10.0).contains(beyond))
        );
        assert!(*reach.end() < 145.0 && *reach.start() > 35.0, "{reach:?}");
    }
}
