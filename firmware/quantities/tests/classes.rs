//! Classes of calibration values, and what the ranges of the safety class allow.

use hitch_quantities::Calibration;
use hitch_quantities::calibration::calibration_words::{
    GROUPS, SAFETY_ITEM_COUNT, SCALARS_WORD, items, word_range,
};
use hitch_quantities::calibration::class::{Class, Tightening};
use hitch_quantities::calibration::fitted::Fitted;
use hitch_quantities::calibration::parameter::ParameterInfo;
use hitch_quantities::units::Millisecond;

/// Fastest lowering by the valve curve at 90 degrees.
const FASTEST_MDEG_PER_MS: i32 = 112;
/// Extra travel that a time of the safety class may allow.
const EXTRA_MDEG: i32 = 5_000;

fn scalars() -> impl Iterator<Item = (&'static str, &'static ParameterInfo, Class)> {
    let all = GROUPS.iter().flat_map(|group| {
        let parameters = group.parameters.iter();
        parameters.map(|parameter| (group.name, parameter))
    });
    all.zip(SCALARS_WORD..).map(|((group, parameter), word)| {
        let class = word_range(word).expect("a class").class;
        (group, parameter, class)
    })
}

#[test]
fn a_word_has_the_class_that_its_value_is_declared_with() {
    for (group, parameter, class) in scalars() {
        assert_eq!(class, parameter.class, "{group}.{}", parameter.name);
    }
}

#[test]
fn the_whole_envelope_all_sensor_ranges_and_remote_control_are_of_the_safety_class() {
    for (group, parameter, class) in scalars() {
        if ["safety", "sensors", "lock", "remote"].contains(&group) {
            assert!(class.is_safety(), "{group}.{}", parameter.name);
        }
    }
    let limits = ["lower_limit", "upper_limit"];
    for (_, parameter, class) in scalars().filter(|(group, ..)| *group == "position") {
        assert_eq!(class.is_safety(), limits.contains(&parameter.name));
    }
    let safety = items().filter(|item| item.is_safety);
    assert_eq!(safety.count(), SAFETY_ITEM_COUNT);
}

#[test]
fn a_time_of_the_envelope_allows_no_more_than_five_degrees_or_than_its_default() {
    let times = [
        "command_age",
        "sensor_time",
        "supply_time",
        "frozen_time",
        "still_time",
        "open_time",
        "short_time",
        "decay_time",
        "reference_time",
        "sensor_supply_time",
        "track_time",
        "clock_time",
        "bridged",
        "limit_time",
    ];
    let mut found = 0;
    for (group, parameter, _) in scalars() {
        if !["safety", "sensors"].contains(&group) || !times.contains(&parameter.name) {
            continue;
        }
        found += 1;
        assert_eq!(parameter.suffix, "ms");
        let travel = parameter.max * FASTEST_MDEG_PER_MS;
        assert!(
            travel <= EXTRA_MDEG || parameter.max == parameter.nominal,
            "{group}.{}: {travel} thousandths of a degree",
            parameter.name
        );
    }
    assert_eq!(found, times.len());
}

#[test]
fn an_angle_of_the_envelope_allows_no_more_than_five_degrees_or_than_its_default() {
    for (group, parameter, class) in scalars() {
        let is_travel = group == "safety" && parameter.suffix == "deg";
        if is_travel && class == Class::Safety(Tightening::Down) {
            let most = parameter.nominal.max(EXTRA_MDEG);
            assert!(parameter.max <= most, "{group}.{}", parameter.name);
        }
    }
}

#[test]
fn looser_is_told_by_the_direction() {
    let cases = [
        (Tightening::Up, 5, 4, true),
        (Tightening::Up, 5, 6, false),
        (Tightening::Down, 5, 6, true),
        (Tightening::Down, 5, 4, false),
        (Tightening::None, 5, 4, true),
        (Tightening::None, 5, 6, true),
    ];
    for (tightening, present, new, loosens) in cases {
        assert_eq!(tightening.loosens(present, new), loosens);
        assert_eq!(
            Class::Safety(tightening).requires_key(present, new),
            loosens
        );
        assert!(!tightening.loosens(present, present));
    }
    assert!(!Class::Machine.requires_key(1, 2) && !Class::Live.requires_key(1, 2));
}

#[test]
fn other_safety_values_than_the_shipped_ones_are_told() {
    let mut block = Calibration::nominal();
    assert!(!block.has_other_safety_values(Fitted::default()));
    let fitted = [(true, false), (false, true)].map(|(second_track, second_contact)| Fitted {
        second_track,
        second_contact,
    });
    for fitted in fitted {
        assert!(block.has_other_safety_values(fitted), "not monitored");
        let mut monitoring = block.clone();
        monitoring.monitor(fitted);
        assert!(!monitoring.has_other_safety_values(fitted));
    }
    block.position.upper_limit.0 -= 1_000;
    block.position.approach_gain.0 += 1;
    assert!(
        !block.has_other_safety_values(Fitted::default()),
        "taught and tuned"
    );
    block.safety.open_time = Millisecond(30);
    assert!(block.has_other_safety_values(Fitted::default()));
}
