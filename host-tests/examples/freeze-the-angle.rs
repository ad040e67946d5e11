//! Freezes the angle sensor of drawn machines at random instants, and drives healthy ones for hours.

use clap::Parser;
use hitch_quantities::Calibration;
use rayon::prelude::*;
use truth_rigs::frozen_angle::freeze::{Case, Cost, Kind};
use truth_rigs::frozen_angle::healthy::{FalseTrip, MACHINE_MS, first_fault, first_fault_watched};
use truth_rigs::frozen_angle::quantiles::quantiles_deg;

/// Arguments.
#[derive(Parser)]
struct Arguments {
    /// How many freezes
    #[arg(long, default_value_t = 10_000)]
    freezes: u64,
    /// How many hours healthy machines are driven
    #[arg(long, default_value_t = 10.0)]
    hours: f64,
    /// The first seed
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Freezes that cost more than this are listed, degree
    #[arg(long, default_value_t = 5.0)]
    most_deg: f64,
    /// Another value in the calibration, as in `hitch loop --set`
    #[arg(long, value_name = "GROUP.NAME=VALUE")]
    set: Vec<String>,
    /// Print every millisecond after the freeze of the first seed, as CSV, instead of any table
    #[arg(long)]
    trace: bool,
    /// Print every millisecond of the healthy machine of the first seed, as CSV, up to its first fault
    #[arg(long)]
    trace_healthy: bool,
}

fn main() -> anyhow::Result<()> {
    let arguments = Arguments::parse();
    let mut calibration = Calibration::nominal();
    for setting in &arguments.set {
        hitch_controller_host::calibration_file::set(&mut calibration, setting)
            .map_err(anyhow::Error::msg)?;
    }
    let calibration = calibration
        .sealed()
        .validate()
        .map_err(|error| anyhow::anyhow!("{error:?}"))?;
    if arguments.trace_healthy {
        println!("ms,lever_deg,rocker_deg,lift_a,lower_a,cylinder_bar");
        let mut ms = 0;
        let fault = first_fault_watched(arguments.seed, &calibration, |lever_deg, instant| {
            let [lift_a, lower_a] = instant.currents_a;
            println!(
                "{ms},{lever_deg:.2},{:.3},{lift_a:.3},{lower_a:.3},{:.2}",
                instant.rocker_deg, instant.cylinder_bar
            );
            ms += 1;
        });
        println!("{fault:?}");
        return Ok(());
    }
    if arguments.trace {
        let case = Case::draw(arguments.seed);
        println!("{case:?}");
        println!("ms,rocker_deg,lift_a,lower_a,cylinder_bar,demanded_mm_s");
        let mut ms = 0;
        let cost = case.cost_watched(&calibration, |instant| {
            let [lift_a, lower_a] = instant.currents_a;
            let [_, demanded_mm_s] = instant.speeds_mm_s;
            println!(
                "{ms},{:.3},{lift_a:.3},{lower_a:.3},{:.2},{demanded_mm_s:.1}",
                instant.rocker_deg, instant.cylinder_bar
            );
            ms += 1;
        });
        println!("{cost:?}");
        return Ok(());
    }
    let cases: Vec<(Case, Cost)> = (arguments.seed..arguments.seed + arguments.freezes)
        .into_par_iter()
        .map(|seed| {
            let case = Case::draw(seed);
            let cost = case.cost(&calibration);
            (case, cost)
        })
        .collect();
    print("all", &cases, |_| true);
    print("textbook", &cases, |case| !case.drawn.structured);
    print("structured", &cases, |case| case.drawn.structured);
    print("hold the last sample", &cases, |case| {
        case.kind == Kind::HoldsLast
    });
    print("keep trembling", &cases, |case| case.kind == Kind::Trembles);
    print("lifting", &cases, lifts);
    print("lowering", &cases, |case| !lifts(case));
    print("with pressures", &cases, |case| {
        case.drawn.readings.pressures
    });
    print("without", &cases, |case| !case.drawn.readings.pressures);
    for (case, cost) in &cases {
        if cost.extra_deg > arguments.most_deg {
            println!(
                "seed {} {}: {:.2} deg, off after {:?} ms, {:?}; {:?} at {} ms of {:.1?}, {:.0} kg, {:.0} degC, pressures {}",
                cost.seed,
                kind_of(case.drawn.structured),
                cost.extra_deg,
                cost.off_after_ms,
                cost.fault,
                case.kind,
                case.instant_ms,
                case.drawn.angles_deg,
                case.drawn.conditions.load_kg,
                case.drawn.conditions.oil_temperature_c,
                case.drawn.readings.pressures,
            );
        }
    }
    let machines = (arguments.hours * 3.6e6 / MACHINE_MS as f64).ceil() as u64;
    let faults: Vec<FalseTrip> = (arguments.seed..arguments.seed + machines)
        .into_par_iter()
        .filter_map(|seed| first_fault(seed, &calibration))
        .collect();
    println!(
        "{machines} healthy machines, {MACHINE_MS} ms each: {} faults",
        faults.len()
    );
    for structured in [false, true] {
        println!(
            "{}: {} faults",
            kind_of(structured),
            faults
                .iter()
                .filter(|fault| fault.structured == structured)
                .count()
        );
    }
    for fault in faults {
        println!("{fault:?}");
    }
    Ok(())
}

fn kind_of(structured: bool) -> &'static str {
    if structured { "structured" } else { "textbook" }
}

fn lifts(case: &Case) -> bool {
    case.drawn.angles_deg[1] > case.drawn.angles_deg[0]
}

fn print(title: &str, cases: &[(Case, Cost)], chosen: impl Fn(&Case) -> bool) {
    let costs: Vec<Cost> = cases
        .iter()
        .filter(|(case, _)| chosen(case))
        .map(|(_, cost)| *cost)
        .collect();
    let [median, most, nearly_all, all] = quantiles_deg(&costs);
    println!(
        "{title:22} {:6} freezes: 50 % {median:5.2}  95 % {most:5.2}  99 % {nearly_all:5.2}  100 % {all:5.2} deg",
        costs.len()
    );
}
