//! `hitch controller`: the firmware's controller on standard input and output, for an external plant.
mod input_stream;

use std::io::{self, BufRead, Write};
use std::path::{Path, PathBuf};

use hitch_controller::Controller;
use hitch_controller_host::calibration_file;
use hitch_controller_host::teaching::{self, Teaching};
use hitch_input::input_error::{InputError, Position};
use hitch_quantities::{Outputs, Reason, Trouble};

use super::loop_::calibration;
use crate::commands::controller::input_stream::{Columns, LineError};
use hitch_output::error::Error;
use hitch_output::targets;

/// Header of the output.
const HEADER: &str = "lift_current_a,lower_current_a,state";
/// What it has besides, if the input has a column of draft or slip control.
const FIELD_HEADER: &str =
    ",target_deg,draft_n,set_point_reason,lost_sensor,in_work,time_until_work_s";

/// Arguments of `hitch controller`.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Example: my-plant | hitch controller --calibration calibration.toml\n\n\
    Standard input is CSV: a header, then one line for each millisecond. Required columns: time_s, lever_deg, \
    rocker_angle_deg. Optional columns: cylinder_pressure_bar, pump_pressure_bar, oil_temperature_c, supply_v, \
    jog_deg_per_s, upper_limit_deg, lowering_dial_percent, engine_speed_rpm, measured_lift_current_a, \
    measured_lower_current_a, and the switches transport_lock, hold, quick_lift, teach, consent, up_released, down_released, engage (0 is off). An empty cell \
    is a missing sample. Each line is answered by one line with currents and state. The coils stay off until the lever has \
    been moved through the present angle.\n\n\
    Optional columns of draft, depth and slip control, for a calibration with draft.fitted or depth.fitted = 1: left_draft_pin_percent and \
    right_draft_pin_percent of the supply, ground_speed_m_per_s and wheel_speed_m_per_s (empty where no message was received), \
    draft_set_point_n, mix_percent, slip_limit_percent, depth_sensor_percent of the supply, depth_set_point_mm, and function_code \
    (0 position, 1 draft, 2 mix, 3 depth limit, 4 depth). With one of them the answer has target_deg, draft_n, set_point_reason, lost_sensor, in_work (0 or 1, empty without work.angle) and \
    time_until_work_s (empty while the hitch is not lowered into work) besides.\n\n\
    Teaching is optional. Before the lever capture and away from the ends of travel, set teach to 1 and jog_deg_per_s to any \
    value but 0 (button held, after 20 ms in which it was released): within a minute the controller identifies the opening currents, the valve delays and the ends \
    of travel. The state is teaching, then taught, or not-taught with the reason. The result takes effect when teach \
    is 0 and jog_deg_per_s is empty again; --out saves it."
)]
pub struct Args {
    /// Calibration of the controller; without this option, the nominal one
    #[arg(long, value_name = "C.toml")]
    calibration: Option<PathBuf>,
    /// Write the calibration to this file after teaching
    #[arg(long, value_name = "C.toml")]
    out: Option<PathBuf>,
}

/// Runs the command.
///
/// # Errors
/// If the calibration or a line is invalid, or standard output is closed.
pub fn run(args: &Args) -> Result<(), Error> {
    hitch_output::no_stdout(
        "--out",
        args.out.as_deref(),
        "standard output has the answers",
    )?;
    let inputs: Vec<PathBuf> = args.calibration.iter().cloned().collect();
    targets::Outputs::check([args.out.as_deref()], &inputs)?;
    let controller = Controller::new(calibration(args.calibration.as_ref())?);
    serve(
        controller,
        args.out.as_deref(),
        io::stdin().lock(),
        io::stdout().lock(),
    )
}

/// Answers every line of `input` on `output`, flushed line by line. A taught calibration is written to the file `taught`.
///
/// # Errors
/// If a line is invalid (with line and column), `output` is closed, or the taught calibration cannot be written.
pub fn serve(
    mut controller: Controller,
    taught: Option<&Path>,
    mut input: impl BufRead,
    mut output: impl Write,
) -> Result<(), Error> {
    let mut teaching = Teaching::default();
    let mut line = String::new();
    if !next_line(&mut input, &mut line, 1)? {
        let error = LineError::new(1, "there is no header", Columns::HINT);
        return Err(fault(1, error));
    }
    let mut columns = Columns::parse(&line).map_err(|error| fault(1, error))?;
    let has_field = columns.has_field();
    if has_field {
        answer(&mut output, &[HEADER, FIELD_HEADER].concat())?
    } else {
        answer(&mut output, HEADER)?
    }
    let mut number = 2;
    while next_line(&mut input, &mut line, number)? {
        if !line.trim().is_empty() {
            let inputs = columns
                .inputs(&line)
                .map_err(|error| fault(number, error))?;
            let outputs = controller.step(&inputs);
            let found = teaching.follow(&mut controller, outputs.state);
            if let (Some(path), Some(found)) = (taught, found) {
                hitch_output::write_file(path, calibration_file::write(&found).as_bytes())?;
            }
            let mut reply = reply(&outputs, &controller);
            if has_field {
                reply += &field_reply(&outputs);
            }
            answer(&mut output, &reply)?;
        }
        number += 1;
    }
    Ok(())
}

fn reply(outputs: &Outputs, controller: &Controller) -> String {
    let ampere = |milli: i32| f64::from(milli) * 1e-3;
    let state = teaching::state(outputs, controller);
    format!(
        "{:.3},{:.3},{state}",
        ampere(outputs.lift_current.0),
        ampere(outputs.lower_current.0)
    )
}

/// The cells of [`FIELD_HEADER`]; empty without a draft, a reason, a lost sensor, a threshold of work, or a move to it.
fn field_reply(outputs: &Outputs) -> String {
    let draft = outputs.draft.map(|draft| draft.0.to_string());
    let in_work = outputs
        .in_work
        .map(|in_work| i32::from(in_work).to_string());
    let until_work = outputs
        .time_until_work
        .map(|time| format!("{:.3}", f64::from(time.0) * 1e-3));
    format!(
        ",{:.3},{},{},{},{},{}",
        f64::from(outputs.target.0) * 1e-3,
        draft.unwrap_or_default(),
        outputs.reference.map_or("", Reason::name),
        outputs.trouble.map_or("", Trouble::name),
        in_work.unwrap_or_default(),
        until_work.unwrap_or_default()
    )
}

fn answer(output: &mut impl Write, line: &str) -> Result<(), Error> {
    writeln!(output, "{line}")
        .and_then(|()| output.flush())
        .map_err(Error::Stdout)
}

/// Reads a line; false at the end of the input.
fn next_line(input: &mut impl BufRead, line: &mut String, number: usize) -> Result<bool, Error> {
    const LONGEST_BYTES: u64 = 4096;
    line.clear();
    let read = io::Read::take(&mut *input, LONGEST_BYTES)
        .read_line(line)
        .map_err(|error| {
            let what = format!("cannot be read: {error}");
            fault(number, LineError::new(1, what, "send UTF-8 text"))
        })?;
    if read as u64 == LONGEST_BYTES && !line.ends_with('\n') {
        let what = "the line is longer than 4096 bytes";
        let error = LineError::new(1, what, "end each line with a line feed");
        return Err(fault(number, error));
    }
    Ok(read > 0)
}

fn fault(line: usize, error: LineError) -> Error {
    let place = Position {
        line,
        column: error.column,
    };
    InputError::at(Path::new("standard input"), place, error.what, error.hint).into()
}
