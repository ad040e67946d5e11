//! Tables over many moves: the motion limits, and the worst cases.

use super::draw::Drawn;
use super::session::MoveFigures;

/// A figure of a move with its name and bar.
pub struct Figure {
    /// Name.
    pub name: &'static str,
    /// How it is read off a move.
    pub of: fn(&MoveFigures) -> f64,
    /// Limit of the largest value; the time ratio has its own limits.
    pub bar: f64,
}

/// All figures.
pub const FIGURES: [Figure; 6] = [
    Figure {
        name: "time over shortest",
        of: |figures| figures.ratio,
        bar: f64::INFINITY,
    },
    Figure {
        name: "overshoot, deg",
        of: |figures| figures.overshoot_deg,
        bar: 0.3,
    },
    Figure {
        name: "final error, deg",
        of: |figures| figures.final_error_deg,
        bar: 0.3,
    },
    Figure {
        name: "pressure swing ratio",
        of: |figures| figures.swing_ratio,
        bar: 1.5,
    },
    Figure {
        name: "switched on after arrival",
        of: |figures| f64::from(figures.switched_on_after),
        bar: 0.0,
    },
    Figure {
        name: "fault",
        of: |figures| f64::from(u8::from(figures.fault.is_some())),
        bar: 0.0,
    },
];

/// Median, 95 % quantile, and largest of one figure.
#[must_use]
pub fn spread(moves: &[&MoveFigures], of: fn(&MoveFigures) -> f64) -> [f64; 3] {
    let mut values: Vec<f64> = moves.iter().map(|figures| of(figures)).collect();
    values.sort_by(f64::total_cmp);
    let at = |share: f64| values[((values.len() - 1) as f64 * share).round() as usize];
    [at(0.5), at(0.95), at(1.0)]
}

/// Share of the moves beyond a figure's bar.
#[must_use]
pub fn beyond(moves: &[&MoveFigures], figure: &Figure) -> f64 {
    let count = moves
        .iter()
        .filter(|moved| (figure.of)(moved) > figure.bar)
        .count();
    count as f64 / moves.len() as f64
}

/// The table of a group of moves.
#[must_use]
pub fn table(title: &str, moves: &[&MoveFigures]) -> String {
    let mut text = format!(
        "{title}: {} moves\n{:28}{:>9}{:>9}{:>9}{:>12}\n",
        moves.len(),
        "",
        "median",
        "95 %",
        "largest",
        "beyond bar"
    );
    for figure in &FIGURES {
        let [median, high, largest] = spread(moves, figure.of);
        text += &format!("{:28}{median:9.2}{high:9.2}{largest:9.2}", figure.name);
        text += &if figure.bar.is_finite() {
            format!("{:11.1} %\n", 100.0 * beyond(moves, figure))
        } else {
            "\n".to_owned()
        };
    }
    text
}

/// The worst moves by each figure, with the properties of their machines.
#[must_use]
pub fn worst(moves: &[MoveFigures], machines: &[Drawn], count: usize) -> String {
    let mut text = String::new();
    for figure in &FIGURES {
        let mut sorted: Vec<&MoveFigures> = moves.iter().collect();
        sorted.sort_by(|a, b| (figure.of)(b).total_cmp(&(figure.of)(a)));
        text += &format!("worst by {}\n", figure.name);
        for moved in sorted.into_iter().take(count) {
            let machine = machines.iter().find(|drawn| drawn.seed == moved.seed);
            text += &line(moved, machine);
        }
    }
    text
}

fn line(moved: &MoveFigures, machine: Option<&Drawn>) -> String {
    let mut text = format!(
        "  {}{:5}.{} {:5.1} to {:5.1} deg: {:.2}, over {:.2}, off {:.2}, swing {:.2}, on {} ({:.2} s)",
        if moved.structured { 's' } else { ' ' },
        moved.seed,
        moved.index,
        moved.from_deg,
        moved.to_deg,
        moved.ratio,
        moved.overshoot_deg,
        moved.final_error_deg,
        moved.swing_ratio,
        moved.switched_on_after,
        moved.active_after_s
    );
    if let Some((fault, trip)) = moved.fault {
        text += &format!("; {fault:?} {trip:?}");
    }
    if let Some(machine) = machine {
        let (physics, conditions) = (&machine.physics, machine.conditions);
        let width_a: f64 = physics
            .plays
            .iter()
            .map(|play| 2.0 * play.share * play.half_width_a)
            .sum();
        text += &format!(
            "; noise {:.3} digit {:.3}; {:3.0} kg, {:2.0} C, shifts {:+.2} {:+.2} A, hysteresis {width_a:.2} A, lag {:2.0} ms, air {:.1} %, {}",
            machine.readings.angle_noise_deg,
            machine.readings.angle_digit_deg,
            conditions.load_kg,
            conditions.oil_temperature_c,
            physics.lift_shift_a,
            physics.lower_shift_a,
            conditions.spool_lag_s * 1e3,
            physics.air_ratio * 100.0,
            if machine.readings.pressures {
                "pressures"
            } else {
                "no pressures"
            }
        );
    }
    text + "\n"
}
