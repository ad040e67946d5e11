//! Generic tests of every effect of the catalogue.

use hitch_effects::CATALOGUE;
use hitch_plant::simulation::{Trace, simulate};
use hitch_plant::units::pa_from_bar;
use hitch_plant::{AddedEffect, Channel, Currents, Effect, HitchRig, Model, Rig};

/// A current that rises to `peak_a`, stays and falls, each with a ramp of `ramp_s`.
fn trapezoid(time_s: f64, from_s: f64, to_s: f64, ramp_s: f64, peak_a: f64) -> f64 {
    let edge = ((time_s - from_s) / ramp_s).min((to_s - time_s) / ramp_s);
    peak_a * edge.clamp(0.0, 1.0)
}

/// Runs that show every effect: lifting and lowering in steps and slow ramps, down to the lowest point, on the hitch;
/// and the same on the flow bench at the load's pressure and close to the relief pressure.
fn runs(model: &Model) -> Vec<Trace> {
    let time_s: Vec<f64> = (0..1200).map(|k| f64::from(k) * 0.02).collect();
    let drive = |lift_a: f64, lower_a: f64| -> Vec<Currents> {
        let at = |&t: &f64| Currents {
            lift_a: trapezoid(t, 0.5, 2.5, 0.2, lift_a) + trapezoid(t, 8.0, 13.0, 2.5, 1.7),
            lower_a: trapezoid(t, 4.0, 6.0, 0.2, lower_a) + trapezoid(t, 14.0, 23.0, 2.5, lower_a),
        };
        time_s.iter().map(at).collect()
    };
    let hitch = Rig::Hitch(HitchRig {
        load_kg: 150.0,
        start_angle_rad: 70_f64.to_radians(),
    });
    let bench = |bar: f64| Rig::Flow {
        port_pressure_pa: pa_from_bar(bar),
    };
    [
        (hitch, 20.0, drive(2.0, 1.9)),
        (bench(20.0), 40.0, drive(2.0, 1.9)),
        (bench(150.2), 40.0, drive(3.3, 1.9)),
    ]
    .into_iter()
    .map(|(rig, oil_temperature_c, drive)| simulate(model, rig, oil_temperature_c, &time_s, &drive))
    .collect()
}

/// The models in which an effect can show.
fn starting_points_for(effect: &dyn Effect) -> Vec<Model> {
    let needed = effect.needs();
    starting_points()
        .into_iter()
        .filter(|model| needed.is_none_or(|needed| needed == model.constants().dynamics))
        .collect()
}

fn with(model: &Model, effect: &'static dyn Effect, size: f64) -> Model {
    let mut added = AddedEffect::typical(effect);
    added.values[0] = size;
    model.with_effects(vec![added])
}

/// Largest difference of a channel between two sets of runs, in its unit.
fn difference(a: &[Trace], b: &[Trace], channel: Channel) -> f64 {
    let pairs = a
        .iter()
        .zip(b)
        .flat_map(|(a, b)| a.channel(channel).iter().zip(b.channel(channel)));
    pairs
        .filter(|(a, _)| a.is_finite())
        .map(|(a, b)| (a - b).abs())
        .fold(0.0, f64::max)
}

fn starting_points() -> [Model; 2] {
    [hitch_model_file::nominal(), hitch_model_file::dynamic()]
}

/// Whichever was added first, effects act in the order of the machine: a threshold lies behind the hysteresis of its solenoid.
#[test]
fn effects_act_in_the_order_of_the_catalogue() {
    let model = hitch_model_file::nominal();
    let by_id = |id: &str| {
        let mut added = AddedEffect::typical(hitch_effects::find(id).unwrap());
        added.values[0] = 0.1;
        added
    };
    let pair = ["lower-threshold-shift", "solenoid-hysteresis"].map(by_id);
    let [one, other] = [[0, 1], [1, 0]].map(|order| {
        let effects = order.map(|index: usize| pair[index].clone());
        runs(&model.with_effects(effects.to_vec()))
    });
    for (one, other) in one.iter().zip(&other) {
        for channel in Channel::ALL {
            let bits = |trace: &Trace| -> Vec<u64> {
                let values = trace.channel(channel).iter();
                values.map(|value| value.to_bits()).collect()
            };
            assert_eq!(bits(one), bits(other), "{channel:?}");
        }
    }
    let ranks: Vec<usize> = CATALOGUE.iter().map(|effect| effect.rank()).collect();
    assert!(ranks.is_sorted() && ranks.iter().all(|&rank| rank < CATALOGUE.len()));
}

#[test]
fn a_null_value_gives_the_model_without_the_effect_bit_for_bit() {
    let bits = |traces: &[Trace]| -> Vec<u64> {
        let channels = traces.iter().flat_map(|trace| &trace.channels);
        channels.flatten().map(|value| value.to_bits()).collect()
    };
    for model in starting_points() {
        let without = bits(&runs(&model));
        for effect in CATALOGUE {
            let null = model.with_effects(vec![AddedEffect::null(*effect)]);
            assert!(
                bits(&runs(&null)) == without,
                "{} at null changes {}",
                effect.id(),
                model.name
            );
        }
    }
}

/// The null value is a limit, not a switch: a size of a millionth of the typical one changes almost nothing. Some
/// effects make the plant take finer steps; the discretisation error of its ordinary steps, less than half an
/// instrument's noise, is tolerated.
#[test]
fn next_to_its_null_value_an_effect_is_next_to_nothing() {
    const LEFT: [(Channel, f64); 3] = [
        (Channel::CylinderPressure, 0.04),
        (Channel::Flow, 3e-3),
        (Channel::RockerAngle, 0.017),
    ];
    for model in starting_points() {
        let without = runs(&model);
        for effect in CATALOGUE {
            let size = &effect.parameters()[0];
            let small = with(
                &model,
                *effect,
                size.null + 1e-6 * (size.typical - size.null),
            );
            for (channel, left) in LEFT {
                let change = difference(&runs(&small), &without, channel);
                assert!(change < left, "{}: {change} in {channel:?}", effect.id());
            }
        }
    }
}

#[test]
fn a_typical_value_shows_in_the_channels_that_the_catalogue_names() {
    /// A fifth of the usual noise of each channel.
    const VISIBLE: [f64; 4] = [0.03, 0.02, 0.03, 0.01];
    for effect in CATALOGUE {
        let model = &starting_points_for(*effect)[0];
        let without = runs(model);
        let typical = runs(&with(model, *effect, effect.parameters()[0].typical));
        for &channel in effect.channels() {
            let change = difference(&typical, &without, channel);
            assert!(
                change > VISIBLE[channel.index()],
                "{}: {change} in {channel:?}",
                effect.id()
            );
        }
    }
}

#[test]
fn a_sensor_effect_changes_only_what_its_sensor_shows() {
    let model = hitch_model_file::nominal();
    let lag = CATALOGUE
        .iter()
        .find(|e| e.id() == "angle-sensor-lag")
        .expect("in the catalogue");
    // With any lag the plant takes the steps that the sensor requires.
    let without = runs(&with(&model, *lag, 1e-9));
    let lagged = runs(&with(&model, *lag, 0.1));
    assert!(difference(&lagged, &without, Channel::RockerAngle) > 0.1);
    for channel in [
        Channel::PumpPressure,
        Channel::CylinderPressure,
        Channel::Flow,
    ] {
        assert!(difference(&lagged, &without, channel) == 0.0);
    }
}

#[test]
fn the_catalogue_is_in_order() {
    for (index, effect) in CATALOGUE.iter().enumerate() {
        let id = effect.id();
        assert!(
            CATALOGUE[..index]
                .iter()
                .all(|other| (other.id(), other.form()) != (id, effect.form())),
            "{id} twice"
        );
        assert!(
            id.chars().all(|c| c.is_ascii_lowercase() || c == '-'),
            "{id}"
        );
        assert!(!effect.parameters().is_empty(), "{id} has no parameter");
        for text in [
            effect.title(),
            effect.equation(),
            effect.source(),
            effect.shows(),
        ] {
            assert!(!text.trim().is_empty(), "{id} lacks a text");
        }
        for parameter in effect.parameters() {
            let range = parameter.low..=parameter.high;
            assert!(range.contains(&parameter.typical), "{id}");
        }
        let size = &effect.parameters()[0];
        assert!((size.low..=size.high).contains(&size.null), "{id}");
        assert!(size.typical != size.null, "{id}");
    }
}
