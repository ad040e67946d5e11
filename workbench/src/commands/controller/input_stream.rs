//! Converts CSV lines from a running plant into the controller's inputs.

use hitch_controller_host::samples::{FIRST_OF_FIELD, QUANTITIES, SWITCHES, inputs};
use hitch_input::input_error::quote;
use hitch_input::naming::{offer_names, unknown_name};
use hitch_quantities::Inputs;

/// Required columns.
const NEEDED: [&str; 3] = ["time_s", "lever_deg", "rocker_angle_deg"];
/// All columns: the time, then quantities and switches.
const KNOWN: [&str; 1 + QUANTITIES.len() + SWITCHES.len()] = known();
/// Time step between lines, s: the controller's step, with tolerance for rounded time stamps.
const STEP_S: std::ops::RangeInclusive<f64> = 0.000_45..=0.001_55;

const fn known() -> [&'static str; 1 + QUANTITIES.len() + SWITCHES.len()] {
    let mut names = ["time_s"; 1 + QUANTITIES.len() + SWITCHES.len()];
    let (_, rest) = names.split_at_mut(1);
    let (quantities, switches) = rest.split_at_mut(QUANTITIES.len());
    quantities.copy_from_slice(&QUANTITIES);
    switches.copy_from_slice(&SWITCHES);
    names
}

/// A fault of a line, with its position.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LineError {
    /// Character position, from 1.
    pub column: usize,
    /// Description.
    pub what: String,
    /// Suggested correction.
    pub hint: String,
}

impl LineError {
    /// A fault at a character position.
    pub fn new(column: usize, what: impl Into<String>, hint: impl Into<String>) -> Self {
        let (what, hint) = (what.into(), hint.into());
        Self { column, what, hint }
    }
}

/// The header, and the time of the last line.
#[derive(Debug, Clone)]
pub struct Columns {
    /// Index into [`KNOWN`] of each column.
    order: Vec<usize>,
    time_s: Option<f64>,
}

impl Columns {
    /// Suggested correction for a missing column.
    pub const HINT: &str = "start with a line time_s,lever_deg,rocker_angle_deg";

    /// Reads a header.
    ///
    /// # Errors
    /// If a column is unknown, duplicated or missing.
    pub fn parse(header: &str) -> Result<Self, LineError> {
        let mut order: Vec<usize> = Vec::new();
        for (column, cell) in cells(header.strip_prefix('\u{feff}').unwrap_or(header)) {
            let Some(index) = KNOWN.iter().position(|name| *name == cell) else {
                let what = unknown_name("column", cell, &KNOWN);
                return Err(LineError::new(column, what, offer_names(cell, &KNOWN)));
            };
            if order.contains(&index) {
                let what = format!("column {cell} is duplicated");
                return Err(LineError::new(column, what, "delete one of the two"));
            }
            order.push(index);
        }
        let missing = NEEDED
            .iter()
            .find(|name| !order.iter().any(|&index| KNOWN[index] == **name));
        match missing {
            Some(name) => {
                let what = format!("column {name} is missing");
                Err(LineError::new(1, what, Self::HINT))
            }
            None => Ok(Self {
                order,
                time_s: None,
            }),
        }
    }

    /// Whether there is a column of draft or slip control.
    pub fn has_field(&self) -> bool {
        let field = 1 + FIRST_OF_FIELD..1 + QUANTITIES.len();
        self.order.iter().any(|index| field.contains(index))
    }

    /// The inputs of one line; an empty cell is a missing sample.
    ///
    /// # Errors
    /// If a cell is not a finite number, the number of cells is wrong, or the time does not advance by one millisecond.
    pub fn inputs(&mut self, line: &str) -> Result<Inputs, LineError> {
        let mut values = [None; KNOWN.len()];
        let mut time_column = 1;
        let mut order = self.order.iter();
        for (column, cell) in cells(line) {
            let Some(&index) = order.next() else {
                let what = format!("the line has more than {} cells", self.order.len());
                let hint = "give one cell for each column of the header";
                return Err(LineError::new(column, what, hint));
            };
            if index == 0 {
                time_column = column;
            }
            values[index] = number(column, cell)?;
        }
        if let Some(&index) = order.next() {
            let what = format!("the line has no cell for {}", KNOWN[index]);
            let hint = "give one cell for each column of the header; it may be empty";
            let column = line.trim_end().chars().count() + 1;
            return Err(LineError::new(column, what, hint));
        }
        self.check_time(time_column, values[0])?;
        Ok(inputs_of(&values))
    }

    fn check_time(&mut self, column: usize, time_s: Option<f64>) -> Result<(), LineError> {
        let fault = |what| LineError::new(column, what, "give one line for each millisecond");
        let time_s = time_s.ok_or_else(|| fault("time_s is empty".to_owned()))?;
        if let Some(last_s) = self.time_s.replace(time_s) {
            let step_s = time_s - last_s;
            if !STEP_S.contains(&step_s) {
                let what = format!("time_s advances by {:.6} s instead of 0.001 s", step_s);
                return Err(fault(what));
            }
        }
        Ok(())
    }
}

/// The inputs for values in the order of [`KNOWN`]; a switch is on if its value is not zero.
fn inputs_of(values: &[Option<f64>; KNOWN.len()]) -> Inputs {
    let quantities = std::array::from_fn(|index| values[1 + index]);
    let switches = std::array::from_fn(|index| {
        values[1 + QUANTITIES.len() + index].is_some_and(|value| value != 0.0)
    });
    inputs(&quantities, switches)
}

/// The cells of a line, each with the character position of its start.
fn cells(line: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut column = 1;
    line.trim_end_matches(['\r', '\n'])
        .split(',')
        .map(move |cell| {
            let start = column + cell.chars().take_while(|c| c.is_whitespace()).count();
            column += cell.chars().count() + 1;
            (start, cell.trim())
        })
}

fn number(column: usize, cell: &str) -> Result<Option<f64>, LineError> {
    if cell.is_empty() {
        return Ok(None);
    }
    match cell.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(Some(value)),
        _ => {
            let what = format!("{} is not a finite number", quote(cell));
            let hint = "write a number like 90.25, or leave the cell empty";
            Err(LineError::new(column, what, hint))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hitch_quantities::units::{
        Micrometre, MilliBar, MilliDegree, MillimetrePerSecond, Newton, PerMille,
        RevolutionPerMinute, SupplyShare,
    };
    use hitch_quantities::{Function, Switches};

    const HEADER: &str = "time_s,lever_deg,rocker_angle_deg,supply_v\n";

    fn fault(lines: &[&str]) -> String {
        let mut columns = match Columns::parse(lines[0]) {
            Ok(columns) => columns,
            Err(error) => return format!("1:{}: {}", error.column, error.what),
        };
        for (number, line) in lines.iter().enumerate().skip(1) {
            if let Err(error) = columns.inputs(line) {
                return format!("{}:{}: {}", number + 1, error.column, error.what);
            }
        }
        "no fault".to_owned()
    }

    #[test]
    fn lines_become_inputs_in_any_order_of_columns() {
        let mut columns =
            Columns::parse("rocker_angle_deg, lever_deg,time_s,pump_pressure_bar\r\n").unwrap();
        let inputs = columns.inputs("90.5, ,0,4.25\r\n").unwrap();
        assert_eq!(inputs.rocker_angle, Some(MilliDegree(90_500)));
        assert_eq!((inputs.lever, inputs.supply), (None, None));
        assert_eq!(inputs.pump_pressure, Some(MilliBar(4_250)));
    }

    #[test]
    fn what_the_operator_sets_has_columns_too() {
        let mut columns = Columns::parse(
            "time_s,lever_deg,rocker_angle_deg,lowering_dial_percent,hold,transport_lock,engine_speed_rpm,teach\n",
        )
        .unwrap();
        let inputs = columns.inputs("0,90,90,50.5,1,0,850,1\n").unwrap();
        assert_eq!(inputs.lowering_dial, Some(PerMille(505)));
        assert_eq!(inputs.engine_speed, Some(RevolutionPerMinute(850)));
        assert_eq!(
            inputs.switches,
            Switches {
                hold: true,
                teach: true,
                ..Switches::default()
            }
        );
    }

    #[test]
    fn draft_and_slip_have_columns_too() {
        let header = format!(
            "time_s,lever_deg,rocker_angle_deg,{}",
            QUANTITIES[FIRST_OF_FIELD..].join(",")
        );
        let mut columns = Columns::parse(&header).unwrap();
        let inputs = columns
            .inputs("0,90,90,56.25,56.26,1.8,,18000,50,15.5,2,37.5,250\n")
            .unwrap();
        assert_eq!(inputs.left_pin, Some(SupplyShare(56_250)));
        assert_eq!(inputs.right_pin, Some(SupplyShare(56_260)));
        assert_eq!(inputs.ground_speed, Some(MillimetrePerSecond(1_800)));
        assert_eq!(inputs.wheel_speed, None);
        assert_eq!(inputs.draft_set_point, Some(Newton(18_000)));
        assert_eq!(inputs.mix, Some(PerMille(500)));
        assert_eq!(inputs.slip_limit, Some(PerMille(155)));
        assert_eq!(Function::from_code(inputs.function), Function::Mix);
        assert_eq!(inputs.depth_sensor, Some(SupplyShare(37_500)));
        assert_eq!(inputs.depth_set_point, Some(Micrometre(250_000)));
        assert!(columns.has_field());
        assert!(!Columns::parse(HEADER).unwrap().has_field());
    }

    #[test]
    fn faults_have_a_place() {
        assert_eq!(
            fault(&["time_s,lever_deg,angle\n"]),
            "1:18: column \"angle\" is not known"
        );
        assert_eq!(
            fault(&["time_s,lever_rad,rocker_angle_deg"]),
            "1:8: unit rad is not known, this column has to be lever_deg"
        );
        assert_eq!(
            fault(&["time_s,lever_deg\n"]),
            "1:1: column rocker_angle_deg is missing"
        );
        assert_eq!(
            fault(&["time_s,lever_deg,lever_deg"]),
            "1:18: column lever_deg is duplicated"
        );
        assert_eq!(
            fault(&[HEADER, "0,90,x1,12\n"]),
            "2:6: \"x1\" is not a finite number"
        );
        assert_eq!(
            fault(&[HEADER, "0,90,NaN,12\n"]),
            "2:6: \"NaN\" is not a finite number"
        );
        assert_eq!(
            fault(&[HEADER, "0,90,90\n"]),
            "2:8: the line has no cell for supply_v"
        );
        assert_eq!(
            fault(&[HEADER, "0,90,90,12,1\n"]),
            "2:12: the line has more than 4 cells"
        );
        assert_eq!(
            fault(&[HEADER, "0,90,90,\n", "0.01,90,90,\n"]),
            "3:1: time_s advances by 0.010000 s instead of 0.001 s"
        );
        assert_eq!(fault(&[HEADER, ",90,90,\n"]), "2:1: time_s is empty");
        assert_eq!(
            fault(&[HEADER, "0,1e30,-1e30,\n", "0.001,90,90,\n"]),
            "no fault"
        );
    }
}
