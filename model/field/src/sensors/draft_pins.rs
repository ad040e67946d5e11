//! Two draft pins in the joints of the lower links.
//!
//! A pin is ratiometric: `u / supply = 0.5 + 0.25 F / F_nominal`. Nominal forces of 25 to 160 kN and the ratiometric output
//! are those of Bosch Rexroth KMB (RE 95170); the middle of 50 % and the swing of 25 % are not from the data sheet and to be
//! checked before a real pin is connected.

use crate::noise::Noise;

/// Fault of a pin.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PinFault {
    /// None.
    #[default]
    None,
    /// A broken wire: the input's pull-down gives 0.
    Broken,
    /// Short to the supply: 1.
    ShortToSupply,
}

/// Constants of a pin.
#[derive(Debug, Clone, PartialEq)]
pub struct PinConstants {
    /// Force of the swing of 25 %, N.
    pub nominal_n: f64,
    /// Offset of the output, 1.
    pub zero_offset: f64,
    /// Error of the gain, 1.
    pub gain_error: f64,
    /// One sigma of the output's noise, 1.
    pub noise: f64,
    /// Fault.
    pub fault: PinFault,
}

impl PinConstants {
    /// Output over supply, 0 to 1, for a force in N.
    fn output(&self, force_n: f64, noise: &mut Noise) -> f64 {
        // Drawn in any state, so that a fault of one pin leaves the other as it was.
        let noise = self.noise * noise.normal();
        match self.fault {
            PinFault::None => {
                let swing = 0.25 * (1.0 + self.gain_error) * force_n / self.nominal_n;
                (0.5 + swing + self.zero_offset + noise).clamp(0.0, 1.0)
            }
            PinFault::Broken => 0.0,
            PinFault::ShortToSupply => 1.0,
        }
    }
}

/// Constants of the pair.
#[derive(Debug, Clone, PartialEq)]
pub struct DraftPinsConstants {
    /// Left pin.
    pub left: PinConstants,
    /// Right pin.
    pub right: PinConstants,
    /// Part of the draft that the lower links carry, 1.
    pub lower_link_share: f64,
    /// Part of that in the left link, 1.
    pub left_share: f64,
}

impl DraftPinsConstants {
    /// Pins of 40 kN without errors, with noise of 0.1 % of the supply. The lower links carry all of the draft, which a
    /// secondary source gives as 90 to 100 %.
    #[must_use]
    pub fn two_of_40_kn() -> Self {
        let pin = PinConstants {
            nominal_n: 40e3,
            zero_offset: 0.0,
            gain_error: 0.0,
            noise: 0.001,
            fault: PinFault::None,
        };
        Self {
            left: pin.clone(),
            right: pin,
            lower_link_share: 1.0,
            left_share: 0.5,
        }
    }
}

/// Outputs of both pins over supply, 0 to 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PinReadings {
    /// Left.
    pub left: f64,
    /// Right.
    pub right: f64,
}

/// The pair of pins.
#[derive(Debug, Clone)]
pub struct DraftPins {
    /// Constants; faults may set in at any time.
    pub constants: DraftPinsConstants,
    noise: Noise,
}

impl DraftPins {
    /// Pins with the noise of a seed.
    #[must_use]
    pub fn new(constants: DraftPinsConstants, noise: Noise) -> Self {
        Self { constants, noise }
    }

    /// Reads the pins at a draft in N.
    pub fn read(&mut self, draft_n: f64) -> PinReadings {
        let links_n = self.constants.lower_link_share * draft_n;
        let left_n = self.constants.left_share * links_n;
        PinReadings {
            left: self.constants.left.output(left_n, &mut self.noise),
            right: self
                .constants
                .right
                .output(links_n - left_n, &mut self.noise),
        }
    }
}
