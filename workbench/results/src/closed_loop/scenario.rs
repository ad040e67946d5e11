//! Scenarios: sets of moves.

use hitch_plant::Model;

/// A move of the lever from one rest to another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Move {
    /// Start angle, degree.
    pub from_deg: f64,
    /// Set point, degree.
    pub to_deg: f64,
    /// Load at the hitch point, kg.
    pub load_kg: f64,
    /// Oil temperature, C.
    pub oil_temperature_c: f64,
}

/// A named set of moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Scenario {
    /// Moves of 5 to 60 degrees about the middle, both ways, at three loads
    Moves,
    /// A subset of them, for a quick check
    Quick,
    /// Small corrections of 1 to 3 degrees, where thresholds matter most
    Fine,
    /// Moves that start or end within a degree of the limits of travel
    Ends,
    /// A small set of moves of 2 to 80 degrees with cold, warm and hot oil, for tuning
    Tuning,
    /// Moves of 2 to 80 degrees with oil at 10, 40 and 70 C: the moves of the motion limits
    Limits,
}

/// Usual oil temperature, C.
pub const OIL_TEMPERATURE_C: f64 = 40.0;
/// Oil from a cold morning to a hot afternoon, C.
const COLD_TO_HOT_C: [f64; 3] = [10.0, OIL_TEMPERATURE_C, 70.0];
/// Distance of moves to the ends from a mechanical end, degree.
const END_DEG: f64 = 0.9;
/// Largest move of a scenario, and the distance that it keeps from the ends of travel in total, degree.
const LARGEST_DEG: f64 = 80.0;
const CLEAR_DEG: f64 = 10.0;

/// An angle, rad, in tenths of a degree.
fn tenth_deg(angle_rad: f64) -> f64 {
    (10.0 * angle_rad.to_degrees()).round() / 10.0
}

/// Middle of the travel, and the part of the travel that is clear of its ends, degree.
pub fn middle_and_room_deg(model: &Model) -> (f64, f64) {
    let (low_rad, high_rad) = model.linkage().swing_rad();
    let middle_deg = tenth_deg(0.5 * (low_rad + high_rad));
    (middle_deg, (high_rad - low_rad).to_degrees() - CLEAR_DEG)
}

impl Scenario {
    /// The moves of the scenario for a machine, about the middle of its travel, with the given loads, kg; without them,
    /// with its [usual ones](Model::usual_loads_kg). A machine with a short travel has shorter moves.
    #[must_use]
    pub fn moves(self, model: &Model, loads_kg: Option<&[f64]>) -> Vec<Move> {
        self.moves_with_oil(model, loads_kg, None)
    }

    /// The same with oil at these temperatures, C; without them, with those of the scenario.
    #[must_use]
    pub fn moves_with_oil(
        self,
        model: &Model,
        loads_kg: Option<&[f64]>,
        oil_temperatures_c: Option<&[f64]>,
    ) -> Vec<Move> {
        let (low_rad, high_rad) = model.linkage().swing_rad();
        let (middle_deg, room_deg) = middle_and_room_deg(model);
        let scale = (room_deg / LARGEST_DEG).min(1.0);
        let about_middle = |span_deg: f64| {
            let half_deg = 0.5 * scale * span_deg;
            (middle_deg - half_deg, middle_deg + half_deg)
        };
        let pairs: Vec<(f64, f64)> = match self {
            Self::Moves => [5.0, 10.0, 20.0, 40.0, 60.0].map(about_middle).to_vec(),
            Self::Quick => [5.0, 30.0].map(about_middle).to_vec(),
            Self::Fine => [1.0, 2.0, 3.0].map(about_middle).to_vec(),
            Self::Ends => {
                let end_rad = END_DEG.to_radians();
                let (low, high) = (tenth_deg(low_rad + end_rad), tenth_deg(high_rad - end_rad));
                vec![(low, low + 20.0 * scale), (high - 20.0 * scale, high)]
            }
            Self::Tuning => [2.0, 8.0, 25.0, 80.0].map(about_middle).to_vec(),
            Self::Limits => [2.0, 5.0, 10.0, 20.0, 40.0, 60.0, 80.0]
                .map(about_middle)
                .to_vec(),
        };
        let temperatures_c = oil_temperatures_c.unwrap_or(match self {
            Self::Limits | Self::Tuning => &COLD_TO_HOT_C,
            _ => &[OIL_TEMPERATURE_C],
        });
        both_ways(
            &pairs,
            loads_kg.unwrap_or(&model.usual_loads_kg()),
            temperatures_c,
        )
    }
}

/// Moves between two angles, degree, in both directions, for each load and oil temperature.
pub fn both_ways(pairs: &[(f64, f64)], loads_kg: &[f64], oil_temperatures_c: &[f64]) -> Vec<Move> {
    let mut moves = Vec::new();
    for &load_kg in loads_kg {
        for &oil_temperature_c in oil_temperatures_c {
            for &(low, high) in pairs {
                for (from_deg, to_deg) in [(low, high), (high, low)] {
                    moves.push(Move {
                        from_deg,
                        to_deg,
                        load_kg,
                        oil_temperature_c,
                    });
                }
            }
        }
    }
    moves
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_papers_rig_has_its_own_loads_and_angles() {
        let model = hitch_model_file::dynamic();
        assert_eq!(model.usual_loads_kg(), [50.0, 150.0, 250.0]);
        let ends = Scenario::Ends.moves(&model, None);
        assert_eq!((ends[0].from_deg, ends[0].to_deg), (45.0, 65.0));
        assert_eq!((ends[2].from_deg, ends[2].to_deg), (115.0, 135.0));
        let largest = Scenario::Limits.moves(&model, Some(&[70.0]));
        let largest = largest.iter().map(|of| (of.load_kg, of.from_deg));
        assert_eq!(
            largest.fold((0.0, 180.0), |a: (f64, f64), b| (b.0, a.1.min(b.1))),
            (70.0, 50.0)
        );
    }

    #[test]
    fn stated_loads_replace_those_of_the_relief_setting() {
        let nominal = hitch_model_file::nominal();
        let mut constants = nominal.constants().clone();
        constants.usual_loads.usual_kg = 180.0;
        constants.usual_loads.heavy_kg = 420.0;
        let model = nominal.with_constants(constants).expect("a linkage");
        assert_eq!(model.usual_loads_kg(), [50.0, 180.0, 420.0]);
    }

    #[test]
    fn two_larger_cylinders_have_larger_loads() {
        let nominal = hitch_model_file::nominal();
        let mut constants = nominal.constants().clone();
        constants.cylinder.count = 2;
        constants.cylinder.bore_m = 0.1;
        let model = nominal.with_constants(constants).expect("a linkage");
        assert_eq!(model.usual_loads_kg(), [200.0, 600.0, 1000.0]);
    }
}
