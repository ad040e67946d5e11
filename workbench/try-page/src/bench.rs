//! The requests of the closed loop, and their answers.
//!
//! Paths, fields and answers are those of `hitch serve` (`workbench/page/src/live/routes.rs`).

use std::path::Path;
use std::sync::LazyLock;

use hitch_closed_loop::driven::{
    Described, Machine, MachineError, Models, Orders, Pair, wrong_advance,
};
use hitch_controller_host::calibration_file;
use hitch_input::input_error::InputError;
use hitch_input::source_file::SourceFile;
use serde::Deserialize;
use serde_json::{Value, json};

/// The hitch of the page.
const MODEL: &str = include_str!("../assets/worn.toml");

/// The hitch of the page, and the calibrations of it and of the paper's model.
static MACHINE: LazyLock<Result<Machine, Fault>> = LazyLock::new(|| {
    let source = SourceFile::of(Path::new("worn.toml"), MODEL.as_bytes())?;
    let present = hitch_model_file::parse(&source)?;
    Ok(Models::new(hitch_model_file::nominal(), present).machine()?)
});

/// The reason why a request has no answer.
#[derive(Debug, Clone, thiserror::Error)]
#[error("{0}")]
struct Fault(String);

impl From<MachineError> for Fault {
    fn from(error: MachineError) -> Self {
        Self(error.to_string())
    }
}

impl From<InputError> for Fault {
    fn from(error: InputError) -> Self {
        Self(error.to_string())
    }
}

/// A request.
#[derive(Debug, Deserialize)]
#[serde(tag = "path")]
enum Request {
    /// What the page draws before it starts anything.
    #[serde(rename = "loop/describe")]
    Describe {
        /// Conditions at the start.
        orders: Orders,
    },
    /// Starts both hitches at rest with the lever at its position.
    #[serde(rename = "loop/open")]
    Open {
        /// Conditions at the start.
        orders: Orders,
    },
    /// Advances both hitches.
    #[serde(rename = "loop/step")]
    Step {
        /// Orders during the advance.
        orders: Orders,
        /// Length of the advance, ms.
        milliseconds: u32,
    },
    /// The calibration of the hitch, as the text of a file.
    #[serde(rename = "calibration")]
    Calibration,
}

/// The closed loop of the page.
#[derive(Default)]
pub struct Bench {
    pair: Option<Pair<'static>>,
}

impl Bench {
    /// Answers a request, a text of JSON, with `{"answer": …}` or `{"fault": {"what": …}}`.
    pub fn answer(&mut self, request: &[u8]) -> String {
        let answered = serde_json::from_slice(request)
            .map_err(|error| Fault(format!("the request is wrong: {error}")))
            .and_then(|request| self.respond(request));
        let answer = match answered {
            Ok(answer) => json!({ "answer": answer }),
            Err(Fault(what)) => json!({ "fault": { "what": what } }),
        };
        answer.to_string()
    }

    fn respond(&mut self, request: Request) -> Result<Value, Fault> {
        let machine = MACHINE.as_ref().map_err(Fault::clone)?;
        match request {
            Request::Describe { orders } => view(machine, &checked(orders)?),
            Request::Open { orders } => {
                let orders = checked(orders)?;
                if let Some(what) = machine.refusal(&orders) {
                    return Err(Fault(what));
                }
                self.pair = Some(Pair::new(machine, &orders, machine.start_deg(&orders)));
                view(machine, &orders)
            }
            Request::Step {
                orders,
                milliseconds,
            } => {
                let orders = checked(orders)?;
                if let Some(what) = wrong_advance(milliseconds) {
                    return Err(Fault(what));
                }
                let pair = self.pair.as_mut();
                let pair = pair.ok_or_else(|| Fault("start the closed loop first".to_owned()))?;
                Ok(json!({ "loops": pair.advance(&orders, milliseconds) }))
            }
            Request::Calibration => Ok(json!(calibration_file::write(&machine.rebuilt))),
        }
    }
}

/// The description of the machine at the lever.
fn view(machine: &Machine, orders: &Orders) -> Result<Value, Fault> {
    Described::new(machine, machine.start_deg(orders), "host", false)
        .map(|described| json!(described))
        .map_err(|error| Fault(format!("the linkage cannot be drawn: {error}")))
}

/// The orders, if all values are in range.
fn checked(orders: Orders) -> Result<Orders, Fault> {
    match orders.fault() {
        Some(what) => Err(Fault(what)),
        None => Ok(orders),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn orders(lever_deg: f64, fault: Value) -> Value {
        json!({ "lever_deg": lever_deg, "button": null, "load_kg": 150.0, "oil_temperature_c": 40.0, "fault": fault })
    }

    fn ask(bench: &mut Bench, request: &Value) -> Value {
        let answer = bench.answer(request.to_string().as_bytes());
        serde_json::from_str(&answer).expect("an answer is JSON")
    }

    fn step(bench: &mut Bench, orders: &Value) -> Value {
        let request = json!({ "path": "loop/step", "orders": orders, "milliseconds": 1000 });
        ask(bench, &request)["answer"]["loops"].clone()
    }

    #[test]
    fn the_lever_moves_both_hitches_and_an_open_sensor_is_a_fault() {
        let mut bench = Bench::default();
        let opened = ask(
            &mut bench,
            &json!({ "path": "loop/open", "orders": orders(90.0, Value::Null) }),
        );
        assert_eq!(opened["answer"]["equal"], false, "{opened}");
        let lever = orders(70.0, Value::Null);
        let moved = (0..8)
            .map(|_| step(&mut bench, &lever))
            .last()
            .expect("steps");
        for hitch in [0, 1] {
            let angles = moved[hitch]["angle_deg"].as_array().expect("angles");
            let last_deg = angles.last().and_then(Value::as_f64).expect("an angle");
            assert!((last_deg - 70.0).abs() < 0.5, "{hitch}: {last_deg}");
        }
        let open = orders(70.0, json!({ "sensor": "angle", "kind": "open" }));
        let broken = step(&mut bench, &open);
        assert_eq!(broken[1]["state"], "fault");
        assert!(broken[1]["fault_text"].is_string(), "{broken}");
    }

    #[test]
    fn cold_oil_slows_the_lowering() {
        let [cold_deg, warm_deg] = [0.0, 80.0].map(|oil_c| {
            let mut bench = Bench::default();
            let at = orders(110.0, Value::Null);
            ask(&mut bench, &json!({ "path": "loop/open", "orders": at }));
            let mut down = orders(60.0, Value::Null);
            down["oil_temperature_c"] = json!(oil_c);
            let request = json!({ "path": "loop/step", "orders": down, "milliseconds": 500 });
            let answer = ask(&mut bench, &request);
            let angles = answer["answer"]["loops"][1]["angle_deg"]
                .as_array()
                .cloned();
            angles
                .and_then(|all| all.last()?.as_f64())
                .expect("an angle")
        });
        println!(
            "after 0.5 s of lowering: {cold_deg:.1} deg with cold oil, {warm_deg:.1} deg with warm oil"
        );
        assert!(cold_deg - warm_deg > 1.0, "{cold_deg} {warm_deg}");
    }

    #[test]
    fn the_calibration_has_the_threshold_of_the_worn_valve() {
        let machine = MACHINE.as_ref().expect("a machine");
        let lower = [&machine.initial, &machine.rebuilt].map(|one| one.lower.threshold().0);
        // The model file shifts the threshold by 0.2 A.
        assert!((lower[1] - lower[0] - 200).abs() <= 5, "{lower:?} mA");
        let answered = ask(&mut Bench::default(), &json!({ "path": "calibration" }));
        let text = answered["answer"].as_str().expect("a text");
        let source = SourceFile::of(Path::new("calibration.toml"), text.as_bytes());
        let read = calibration_file::parse(&source.expect("UTF-8"));
        // The file has flows in rounded litres a minute.
        let read = read.expect("a calibration");
        assert_eq!(read.lower.threshold().0, lower[1]);
        assert_eq!(read.linkage, machine.rebuilt.linkage);
    }

    #[test]
    fn a_wrong_request_is_refused_with_its_reason() {
        let mut bench = Bench::default();
        for (request, reason) in [
            (json!({ "path": "loop/close" }), "loop/close"),
            (
                json!({ "path": "loop/step", "orders": orders(90.0, Value::Null), "milliseconds": 0 }),
                "milliseconds is 0",
            ),
            (
                json!({ "path": "loop/step", "orders": orders(90.0, Value::Null), "milliseconds": 1 }),
                "start",
            ),
            (
                json!({ "path": "loop/open", "orders": orders(4000.0, Value::Null) }),
                "lever_deg is 4000",
            ),
        ] {
            let refused = ask(&mut bench, &request);
            let what = refused["fault"]["what"].as_str().expect("a fault");
            assert!(what.contains(reason), "{what}");
        }
    }
}
