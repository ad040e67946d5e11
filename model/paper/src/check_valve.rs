//! The check valve's cracking pressure, equation 7: `p = stiffness * compression / port area`.
//!
//! The paper measured stiffness and compression of the spring, but only prints the resulting pressure. The pressure can
//! therefore not be computed; this module computes which spring a port of a given size requires.

use hitch_plant::units::{bar_from_pa, pa_from_bar};

use crate::tables::CRACKING_PRESSURE_BAR;

/// A spring and a port that fit the paper's cracking pressure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spring {
    /// Diameter of the port, m.
    pub port_diameter_m: f64,
    /// Compression of the spring with the valve seated, m.
    pub compression_m: f64,
    /// Stiffness of the spring, N/m.
    pub stiffness_n_m: f64,
}

impl Spring {
    /// The spring that opens at the paper's pressure with this port and compression.
    pub fn for_port(port_diameter_m: f64, compression_m: f64) -> Self {
        let force_n = pa_from_bar(CRACKING_PRESSURE_BAR) * area_m2(port_diameter_m);
        Self {
            port_diameter_m,
            compression_m,
            stiffness_n_m: force_n / compression_m,
        }
    }

    /// Cracking pressure by equation 7, bar.
    pub fn cracking_pressure_bar(&self) -> f64 {
        bar_from_pa(self.stiffness_n_m * self.compression_m / area_m2(self.port_diameter_m))
    }
}

fn area_m2(diameter_m: f64) -> f64 {
    std::f64::consts::FRAC_PI_4 * diameter_m * diameter_m
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ten_millimetre_port_needs_twenty_newtons() {
        let spring = Spring::for_port(0.010, 0.005);
        assert!((spring.stiffness_n_m * spring.compression_m - 19.635).abs() < 1e-3);
        assert!((spring.cracking_pressure_bar() - CRACKING_PRESSURE_BAR).abs() < 1e-12);
    }
}
