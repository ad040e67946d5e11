//! Effects that are known in more than one form, against closed forms on the flow bench.

use hitch_model::Model;
use hitch_model::campaign::Channel;
use hitch_model::effects::{AddedEffect, CATALOGUE, Effect, full_name};
use hitch_model::plant::{Currents, Rig};
use hitch_model::simulation::simulate;
use hitch_model::units::pa_from_bar;

fn effect(name: &str) -> &'static dyn Effect {
    let mut catalogue = CATALOGUE.iter().copied();
    catalogue
        .find(|effect| full_name(*effect) == name)
        .expect("an effect of the catalogue")
}

/// The nominal model with one effect.
fn model(name: &str, values: &[f64]) -> Model {
    Model::nominal().with_effects(vec![AddedEffect {
        effect: effect(name),
        values: values.to_vec(),
    }])
}

/// Flow, l/min, that the bench's meter shows under a lift and a lowering current over time.
fn flow_lpm(
    model: &Model,
    port_bar: f64,
    oil_temperature_c: f64,
    time_s: &[f64],
    currents: impl Fn(f64) -> Currents,
) -> Vec<f64> {
    let rig = Rig::Flow {
        port_pressure_pa: pa_from_bar(port_bar),
    };
    let currents: Vec<Currents> = time_s.iter().copied().map(currents).collect();
    let trace = simulate(model, rig, oil_temperature_c, time_s, &currents);
    trace.channel(Channel::Flow).to_vec()
}

/// A current that rests, rises slowly, and falls as slowly: 0.05 A/s between 1.5 and 2.0 A.
fn triangle_a(time_s: f64) -> f64 {
    1.5 + 0.05 * (10.0 - (time_s - 12.0).abs()).max(0.0)
}

/// Choudhury's spool on a triangle: it stays at 1.5 A until the current is a band away, follows it half of what the
/// jump left behind, and does so again on the way down from the peak.
#[test]
fn a_following_spool_sticks_where_the_current_stood_or_turned() {
    let (band_a, jump) = (0.08, 0.6);
    let behind_a = 0.5 * (1.0 - jump) * band_a;
    let spool_a = |time_s: f64| {
        let current_a = triangle_a(time_s);
        let (rises, peak_a) = (time_s < 12.0, 2.0);
        match (rises, current_a) {
            // It came from nothing, and rests as far behind as it followed.
            (true, a) if a - 1.5 <= band_a => 1.5 - behind_a,
            (true, a) => a - behind_a,
            (false, a) if peak_a - a <= band_a => peak_a - behind_a,
            (false, a) => a + behind_a,
        }
    };
    let time_s: Vec<f64> = (0..1050).map(|k| f64::from(k) * 0.02).collect();
    let lift = |time_s: f64| Currents {
        lift_a: triangle_a(time_s),
        lower_a: 0.0,
    };
    let sticking = model("spool-stiction/following", &[band_a, jump]);
    let shown = flow_lpm(&sticking, 20.0, 40.0, &time_s, lift);
    let nominal = Model::nominal();
    let moved = |time_s: f64| Currents {
        lift_a: spool_a(time_s),
        lower_a: 0.0,
    };
    let wanted = flow_lpm(&nominal, 20.0, 40.0, &time_s, moved);
    let at_a_jump = |time_s: f64| {
        [3.6, 13.6]
            .iter()
            .any(|jump_s| (time_s - jump_s).abs() < 0.05)
    };
    for ((time_s, shown), wanted) in time_s.iter().zip(shown).zip(wanted) {
        assert!(
            at_a_jump(*time_s) || (shown - wanted).abs() < 0.02,
            "{shown} l/min at {time_s} s, not {wanted}"
        );
    }
}

/// `tanh(2 lambda / critical)` by hand: 2 * 8 mm/A * 0.2 A * sqrt(2 * 5 bar / 877.3 kg/m3) / (nu * critical).
#[test]
fn a_narrow_gap_passes_less_when_the_oil_is_cold() {
    let lower_a = 1.34;
    let critical = 150.0;
    let still = |_: f64| Currents {
        lift_a: 0.0,
        lower_a,
    };
    let time_s = [0.0, 0.02];
    let nominal = Model::nominal();
    let beyond_a = lower_a - nominal.constants().lower_valve.curve.threshold_a();
    for (oil_temperature_c, mm2_s) in [(20.0, 320.286), (40.0, 95.070), (60.0, 38.117)] {
        let speed_m_s = (2.0 * pa_from_bar(5.0) / 877.3_f64).sqrt();
        let flow_number = 0.008 * beyond_a * speed_m_s / (mm2_s * 1e-6);
        let discharge = (2.0 * flow_number / critical).tanh();
        let wide = flow_lpm(&nominal, 5.0, oil_temperature_c, &time_s, still)[1];
        let narrow = model("oil-viscosity/flow-number", &[critical]);
        let narrow = flow_lpm(&narrow, 5.0, oil_temperature_c, &time_s, still)[1];
        assert!(
            (narrow / wide / discharge - 1.0).abs() < 1e-4,
            "{oil_temperature_c} C: {} of the flow, not {discharge}",
            narrow / wide
        );
    }
}

/// The spool's balance by hand: with a force of 0.3 at 15 bar it travels 1.3 / (1 + 0.3 dp / 15 bar) of its way at
/// another drop.
#[test]
fn a_flow_force_on_the_travel_reads_the_table_at_another_current() {
    let time_s = [0.0, 0.02];
    let nominal = Model::nominal();
    let threshold_a = nominal.constants().lower_valve.curve.threshold_a();
    let pushed = model("flow-force/travel", &[0.3]);
    let flow_at = |model: &Model, port_bar: f64, lower_a: f64| {
        let still = |_: f64| Currents {
            lift_a: 0.0,
            lower_a,
        };
        flow_lpm(model, port_bar, 40.0, &time_s, still)[1]
    };
    for (port_bar, lower_a) in [(5.0, 1.5), (15.0, 2.0), (60.0, 2.0), (60.0, 3.0)] {
        let balance = 1.3 / (1.0 + 0.3 * port_bar / 15.0);
        let read_at_a = threshold_a + (lower_a - threshold_a) * balance;
        let wanted = flow_at(&nominal, port_bar, read_at_a);
        let shown = flow_at(&pushed, port_bar, lower_a);
        assert!(
            (shown - wanted).abs() < 1e-6,
            "{port_bar} bar: {shown}, not {wanted}"
        );
    }
}
