//! Column names in German and English.

use hitch_campaign::survey::{LogColumn, is_in, without_group, words};

/// Words in the name of a log's column that support or exclude a run's column.
#[derive(Debug)]
pub struct Words {
    /// The run's column.
    pub channel: &'static str,
    /// Words of its quantity.
    quantity: &'static [&'static str],
    /// Words that identify its channel; empty if the quantity has only one.
    which: &'static [&'static str],
    /// Words that exclude it.
    not: &'static [&'static str],
}

const CURRENT: &[&str] = &[
    "strom", "current", "ampere", "magnet", "solenoid", "ventil", "valve", "coil", "i",
];
const PRESSURE: &[&str] = &["druck", "pressure", "press", "p"];
const NO_MEASUREMENT: [&str; 9] = [
    "soll",
    "target",
    "setpoint",
    "desired",
    "reference",
    "command",
    "cmd",
    "request",
    "demand",
];

/// Words of every column except the times.
pub static CHANNELS: [Words; 7] = [
    Words {
        channel: "lift_current_a",
        quantity: CURRENT,
        which: &[
            "heben", "heb", "lift", "lifting", "raise", "raising", "up", "auf",
        ],
        not: &[
            "druck",
            "pressure",
            "volumenstrom",
            "senken",
            "lower",
            "flow",
            "winkel",
            "angle",
        ],
    },
    Words {
        channel: "lower_current_a",
        quantity: CURRENT,
        which: &["senken", "senk", "lower", "lowering", "down", "ab"],
        not: &[
            "druck",
            "pressure",
            "volumenstrom",
            "heben",
            "lift",
            "flow",
            "winkel",
            "angle",
        ],
    },
    Words {
        channel: "pump_pressure_bar",
        quantity: PRESSURE,
        which: &[
            "pumpe",
            "pump",
            "pumpen",
            "supply",
            "versorgung",
            "system",
            "pumpendruck",
        ],
        not: &[
            "zylinder",
            "cylinder",
            "temperatur",
            "temperature",
            "flow",
            "strom",
        ],
    },
    Words {
        channel: "cylinder_pressure_bar",
        quantity: PRESSURE,
        which: &[
            "zylinder",
            "zyl",
            "zylinderdruck",
            "cylinder",
            "cyl",
            "load",
            "last",
            "port",
        ],
        not: &[
            "pumpe",
            "pump",
            "temperatur",
            "temperature",
            "weg",
            "flow",
            "strom",
        ],
    },
    Words {
        channel: "flow_lpm",
        quantity: &["durchfluss", "volumenstrom", "flow", "flowrate", "q"],
        which: &[],
        not: &["temperatur", "temperature"],
    },
    Words {
        channel: "rocker_angle_deg",
        quantity: &[
            "winkel", "angle", "rocker", "hubwelle", "phi", "position", "lage", "weg", "stroke",
            "travel",
        ],
        which: &[],
        not: &[
            "druck",
            "pressure",
            "strom",
            "current",
            "temperatur",
            "temperature",
        ],
    },
    Words {
        channel: "oil_temperature_c",
        quantity: &["temperatur", "temperature", "temp", "t"],
        which: &["öl", "oel", "oil", "fluid", "tank"],
        not: &["luft", "air", "kühlwasser", "coolant", "motor", "engine"],
    },
];

impl Words {
    /// Score of a name: quantity 1, channel 2.
    #[must_use]
    pub fn score(&self, name: &str) -> i32 {
        // The name of a group is that of a rate or a device.
        let words = words(without_group(name).unwrap_or(name));
        let has = |known: &[&str]| known.iter().any(|known| is_in(known, &words));
        if has(self.not) {
            return 0;
        }
        // German compounds: Öltemperatur.
        let joined = |word: &String| {
            let mut heads = self.which.iter();
            heads.any(|head| {
                let tail = word.strip_prefix(head);
                tail.is_some_and(|tail| self.quantity.contains(&tail))
            })
        };
        let is_told = has(self.which) || words.iter().any(joined);
        let score = i32::from(has(self.quantity)) + 2 * i32::from(is_told);
        score - 4 * i32::from(has(&NO_MEASUREMENT))
    }

    /// Whether name or comment of a column identifies it, whatever its unit.
    #[must_use]
    pub fn names(&self, column: &LogColumn) -> bool {
        let least = if self.is_only_one() { 1 } else { 2 };
        self.score(&column.name).max(self.score(&column.comment)) >= least
    }

    /// Whether the quantity has only one channel.
    #[must_use]
    pub fn is_only_one(&self) -> bool {
        self.which.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn best(name: &str) -> &'static str {
        let best = CHANNELS
            .iter()
            .max_by_key(|words| words.score(name))
            .unwrap();
        assert!(best.score(name) > 0, "{name}");
        best.channel
    }

    #[test]
    fn names_are_understood_in_german_and_english() {
        for (name, expected) in [
            ("Ventil Heben Strom", "lift_current_a"),
            ("Magnetstrom_Senken", "lower_current_a"),
            ("LiftCurrent", "lift_current_a"),
            ("current_valve_lower", "lower_current_a"),
            ("Pumpendruck", "pump_pressure_bar"),
            ("p_zyl", "cylinder_pressure_bar"),
            ("Cylinder Pressure", "cylinder_pressure_bar"),
            ("Volumenstrom", "flow_lpm"),
            ("Winkel Hubwelle", "rocker_angle_deg"),
            ("Öltemperatur Tank", "oil_temperature_c"),
            ("Oeltemperatur", "oil_temperature_c"),
        ] {
            assert_eq!(best(name), expected, "{name}");
        }
    }

    #[test]
    fn what_is_wanted_is_not_what_was_measured() {
        let lift = &CHANNELS[0];
        assert!(lift.score("Strom Heben Soll") < lift.score("Strom Heben"));
    }
}
