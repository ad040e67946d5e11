//! Scenarios: sets of moves.

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
    /// Moves of 5 to 60 degrees about the middle, both ways, at 50, 150 and 250 kg
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

/// Loads of the rig, kg.
const LOADS_KG: [f64; 3] = [50.0, 150.0, 250.0];
/// Oil temperature of the rig's data, C.
const OIL_TEMPERATURE_C: f64 = 40.0;
/// Oil from a cold morning to a hot afternoon, C.
const COLD_TO_HOT_C: [f64; 3] = [10.0, OIL_TEMPERATURE_C, 70.0];
/// Angle at which the rocker points straight down, degree: the middle of the travel.
const MIDDLE_DEG: f64 = 90.0;

impl Scenario {
    /// The moves of the scenario, restricted to `load_kg` if given.
    #[must_use]
    pub fn moves(self, load_kg: Option<f64>) -> Vec<Move> {
        let about_middle =
            |span_deg: f64| (MIDDLE_DEG - span_deg / 2.0, MIDDLE_DEG + span_deg / 2.0);
        let pairs: Vec<(f64, f64)> = match self {
            Self::Moves => [5.0, 10.0, 20.0, 40.0, 60.0].map(about_middle).to_vec(),
            Self::Quick => [5.0, 30.0].map(about_middle).to_vec(),
            Self::Fine => [1.0, 2.0, 3.0].map(about_middle).to_vec(),
            Self::Ends => vec![(45.0, 65.0), (115.0, 135.0)],
            Self::Tuning => [2.0, 8.0, 25.0, 80.0].map(about_middle).to_vec(),
            Self::Limits => [2.0, 5.0, 10.0, 20.0, 40.0, 60.0, 80.0]
                .map(about_middle)
                .to_vec(),
        };
        let temperatures_c: &[f64] = match self {
            Self::Limits | Self::Tuning => &COLD_TO_HOT_C,
            _ => &[OIL_TEMPERATURE_C],
        };
        let loads = load_kg.map_or(LOADS_KG.to_vec(), |load| vec![load]);
        let mut moves = Vec::new();
        for load_kg in loads {
            for &oil_temperature_c in temperatures_c {
                for &(low, high) in &pairs {
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
}
