//! The hitch on the bus in the form for the page: the same as that of a simulated hitch.

use std::time::Instant;

use hitch_closed_loop::driven::HitchView;
use hitch_protocols::j1939::trouble::Code;

use super::super::answer::{Connection, LoopAnswer};
use super::heard::{Heard, Hitch, TimedSample};
use super::measured::Measured;
use super::state::State;
use super::words;
use hitch_ecu_host::xcp_tool::{BusAddress, ListenMode};

/// Largest raw position that is data, and percent a bit.
const LARGEST_POSITION: u8 = 250;
const PERCENT_PER_BIT: f64 = 0.4;

/// Samples and present state.
pub fn shown(
    state: &State,
    address: &BusAddress,
    samples: &[TimedSample],
    now: Instant,
) -> LoopAnswer {
    let each = |value: fn(&Measured) -> Option<f64>| -> Vec<Option<f64>> {
        samples.iter().map(|(_, sample)| value(sample)).collect()
    };
    let problem = problem(state, address, now);
    let hitch = match &state.adapter {
        Ok(_) => state.heard.hitch(now),
        Err(_) => None,
    };
    let codes = hitch.map_or(&[][..], |hitch| hitch.codes(now));
    let (name, text) = match (hitch, &problem) {
        (Some(hitch), _) => said(hitch),
        (None, Some(problem)) => ("not heard".to_owned(), problem.clone()),
        (None, None) => ("not heard".to_owned(), String::new()),
    };
    let hitch_view = HitchView {
        time_s: samples.iter().map(|(time_s, _)| *time_s).collect(),
        angle_deg: each(|sample| sample.angle_deg),
        shown_deg: each(|sample| sample.angle_deg),
        lift_a: each(|sample| sample.lift_a),
        lower_a: each(|sample| sample.lower_a),
        cylinder_bar: each(|sample| sample.cylinder_bar),
        pump_bar: each(|sample| sample.pump_bar),
        state: name,
        state_text: text,
        fault: joined(codes, ", ", |code| {
            format!("SPN {} FMI {}", code.spn, code.fmi)
        }),
        fault_text: joined(codes, "; ", words::trouble),
        trip_text: None,
        last_move: None,
        field: None,
    };
    let connection = Connection {
        connected: state.adapter.is_ok(),
        problem,
        text: listening(state, address, hitch),
        position_percent: hitch.and_then(position_percent),
    };
    LoopAnswer {
        loops: vec![hitch_view],
        speed: None,
        behind: None,
        bus: Some(connection),
    }
}

/// Why there are no data; `None` if they arrive.
fn problem(state: &State, address: &BusAddress, now: Instant) -> Option<String> {
    let heard: &Heard = &state.heard;
    let mode = match &state.adapter {
        Ok(mode) => *mode,
        Err(reason) => {
            return Some(format!(
                "The connection to {address} is lost: {reason}. It is tried again each second."
            ));
        }
    };
    if !heard.is_alive(now) {
        let alone = match mode {
            ListenMode::Acknowledging => "",
            ListenMode::ListenOnly | ListenMode::AsConfigured => {
                " A listen-only adapter receives nothing from an ECU that is alone on the bus, as no node acknowledges \
                 its frames."
            }
        };
        return Some(format!(
            "The bus is silent. Is the ECU running, and the bus up at 250 kbit/s?{alone}"
        ));
    }
    if heard.hitch(now).is_none() {
        return Some(
            "Other nodes send, but no hitch sends its status (PGN 65093). Is the ECU running?"
                .to_owned(),
        );
    }
    (!heard.is_measured(now)).then(|| {
        "The hitch sends no measured values (PGN 65349 and 65350): set the parameter bus.measured_period of the ECU."
            .to_owned()
    })
}

/// The connection in one sentence.
fn listening(state: &State, address: &BusAddress, hitch: Option<&Hitch>) -> String {
    let how = match &state.adapter {
        Ok(ListenMode::ListenOnly) => "in listen-only mode",
        Ok(ListenMode::Acknowledging) => {
            "with an adapter that has no listen-only mode: it acknowledges frames"
        }
        Ok(ListenMode::AsConfigured) => "in the mode in which the interface was started",
        Err(_) => return format!("Not connected to {address}."),
    };
    let whose = hitch.map_or(String::new(), |hitch| {
        format!(" Hitch at address {}.", hitch.source)
    });
    format!("Listens to {address}, {how}.{whose}")
}

/// Reported position, 0 lowest; `None` if its sensor is bad.
fn position_percent(hitch: &Hitch) -> Option<f64> {
    let raw = hitch.status.position;
    (raw <= LARGEST_POSITION).then(|| f64::from(raw) * PERCENT_PER_BIT)
}

/// State of a hitch in short, and as sentences.
fn said(hitch: &Hitch) -> (String, String) {
    let limit = words::limit(hitch.status.limit);
    match words::exit(hitch.status.exit) {
        None => (limit.to_owned(), format!("Control: {limit}.")),
        Some(exit) => (
            exit.to_owned(),
            format!(
                "Control: {limit}. Remote control is not possible, exit code {}: {exit}.",
                hitch.status.exit as u8
            ),
        ),
    }
}

fn joined(codes: &[Code], between: &str, text: impl Fn(&Code) -> String) -> Option<String> {
    let texts: Vec<String> = codes.iter().map(text).collect();
    (!texts.is_empty()).then(|| texts.join(between))
}
