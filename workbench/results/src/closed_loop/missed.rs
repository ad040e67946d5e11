//! Why a move never arrived.

use hitch_closed_loop::ARRIVED_DEG;
use hitch_quantities::Fault;

use super::metrics::MoveResult;
use super::moves::{LoopRun, MoveTrace};
use super::show::name;

/// Describes the first move that never arrived, with its likely cause; `None` if all arrived.
#[must_use]
pub fn first_missed(run: &LoopRun) -> Option<String> {
    let mut missed = run
        .results
        .iter()
        .zip(&run.traces)
        .enumerate()
        .filter(|(_, (result, _))| !result.arrived);
    let (index, (result, trace)) = missed.next()?;
    let others = match missed.count() {
        0 => String::new(),
        1 => "; 1 other move does not arrive either".to_owned(),
        count => format!("; {count} other moves do not arrive either"),
    };
    Some(format!(
        "move {} never arrives ({} deg, {:.0} kg, {:.0} C): {}{others}",
        index + 1,
        name(result),
        result.load_kg,
        result.oil_temperature_c,
        cause(result, trace),
    ))
}

/// The likely cause, from the figures of the move, its first fault and its last sample.
fn cause(result: &MoveResult, trace: &MoveTrace) -> String {
    let end = &trace.end;
    if result.shortest_s.is_nan() {
        return if result.to_deg > result.from_deg {
            "the pump cannot lift this load there, as even the ideal manoeuvre shows; take a smaller one".to_owned()
        } else {
            "this load does not lower the hitch there, as even the ideal manoeuvre shows; take a larger one".to_owned()
        };
    }
    if let Some(fault) = trace.fault {
        return of_fault(fault);
    }
    let target_deg = f64::from(end.outputs.target.0) * 1e-3;
    if (target_deg - result.to_deg).abs() > ARRIVED_DEG {
        return format!(
            "the calibration limits the set point to {target_deg:.1} deg; check its range of travel"
        );
    }
    if result.overshoot_deg > ARRIVED_DEG {
        return format!(
            "it passes the set point by {:.1} deg; check the valve map (`hitch calibrate`) and position.approach_gain",
            result.overshoot_deg
        );
    }
    let is_driven = end.outputs.lift_current.0 > 0 || end.outputs.lower_current.0 > 0;
    if is_driven {
        format!(
            "it is still driven at the end, {:.1} deg away; check the valve map (`hitch calibrate`) and the speeds in [position]",
            result.final_error_deg
        )
    } else {
        format!(
            "it rests {:.1} deg away with both coils off; check position.stop_band and position.restart_band",
            result.final_error_deg
        )
    }
}

fn of_fault(fault: Fault) -> String {
    let advice = match fault {
        Fault::NotMoving | Fault::NotFollowing => {
            "the valve map does not fit the plant; build it with `hitch calibrate`"
        }
        Fault::Sinking => "it leaks faster than it is corrected",
        Fault::Envelope => {
            "the safety envelope has cut the coils; check the limits of the calibration"
        }
        _ => "a check of the inputs has cut the coils; check the limits of the calibration",
    };
    format!("the controller reports `{}`: {advice}", fault.name())
}
