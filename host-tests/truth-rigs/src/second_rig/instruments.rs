//! Instruments and logger of a run: offset, noise, resolution, gaps, clock offsets.

use hitch_campaign::Noise;
use rand::Rng;
use rand_distr::{Distribution, StandardNormal};

use super::test_stand::Reading;

/// One sigma of the four channels, bar, bar, l/min, degree.
pub const CHANNEL_SIGMA: [f64; 4] = [0.15, 0.10, 0.15, 0.05];

/// The logger's last digit of the four channels.
const DIGIT: f64 = 0.02;

/// The logger's last digit of the currents, A.
const CURRENT_DIGIT_A: f64 = 0.001;

/// Correlation of slow noise from one sample to the next.
const SLOWNESS: f64 = 0.95;

/// Port pressure of a flow bench in the first sample, before pressurisation, bar.
const EMPTY_PORT_BAR: f64 = 3.0;

/// Noise as a campaign states it, with this sigma of the currents, A.
#[must_use]
pub fn stated_noise(current_sigma_a: f64) -> Noise {
    Noise {
        lift_current_a: Some(current_sigma_a),
        lower_current_a: Some(current_sigma_a),
        channels: CHANNEL_SIGMA.map(Some),
        oil_temperature_c: None,
    }
}

/// The instruments of a campaign.
#[derive(Debug, Clone)]
pub struct Instruments {
    /// Share of every noise's variance that is slow.
    pub slow_share: f64,
    /// One sigma of the logged currents, A.
    pub current_sigma_a: f64,
    /// Which of the four channels are logged at all.
    pub logged: [bool; 4],
    /// How many samples each of them is late.
    pub late_samples: [usize; 4],
    /// Dropouts a minute.
    pub dropouts_per_minute: f64,
}

impl Instruments {
    /// Good instruments.
    #[must_use]
    pub fn good() -> Self {
        Self {
            slow_share: 0.0,
            current_sigma_a: 0.003,
            logged: [true; 4],
            late_samples: [0; 4],
            dropouts_per_minute: 0.0,
        }
    }

    /// Logs a current, A; the logger shows nothing below zero.
    pub fn log_current(&self, truth_a: &[f64], random: &mut impl Rng) -> Vec<f64> {
        let noise = self.noise(truth_a.len(), random);
        truth_a
            .iter()
            .zip(noise)
            .map(|(a, noise)| rounded((a + self.current_sigma_a * noise).max(0.0), CURRENT_DIGIT_A))
            .collect()
    }

    /// Logs one channel by its index; `None` if it is not logged or there is nothing to show.
    pub fn log_channel(
        &self,
        channel: usize,
        readings: &[Reading],
        random: &mut impl Rng,
    ) -> Option<Vec<f64>> {
        let on_hitch = readings[0][3].is_finite();
        if !self.logged[channel] || !readings[0][channel].is_finite() {
            return None;
        }
        let noise = self.noise(readings.len(), random);
        let mut shown: Vec<f64> = noise
            .into_iter()
            .enumerate()
            .map(|(sample, noise)| {
                let seen = sample.saturating_sub(self.late_samples[channel]);
                let truth = if channel == 1 && !on_hitch && seen == 0 {
                    EMPTY_PORT_BAR
                } else {
                    readings[seen][channel]
                };
                rounded(truth + CHANNEL_SIGMA[channel] * noise, DIGIT)
            })
            .collect();
        self.drop_out(&mut shown, random);
        Some(shown)
    }

    /// Standard normal noise, part of it slow.
    fn noise(&self, samples: usize, random: &mut impl Rng) -> Vec<f64> {
        let mut normal = || -> f64 { StandardNormal.sample(random) };
        let mut slow = normal();
        (0..samples)
            .map(|_| {
                slow = SLOWNESS * slow + (1.0 - SLOWNESS * SLOWNESS).sqrt() * normal();
                (1.0 - self.slow_share).sqrt() * normal() + self.slow_share.sqrt() * slow
            })
            .collect()
    }

    /// Cuts gaps of up to a fifth of a second.
    fn drop_out(&self, shown: &mut [f64], random: &mut impl Rng) {
        let minutes = shown.len() as f64 / super::test_stand::SAMPLE_RATE_HZ / 60.0;
        let gaps = (self.dropouts_per_minute * minutes).round() as usize;
        for _ in 0..gaps {
            let start = random.random_range(0..shown.len());
            let end = (start + random.random_range(1..10)).min(shown.len());
            shown[start..end].fill(f64::NAN);
        }
    }
}

fn rounded(value: f64, digit: f64) -> f64 {
    // Rounded through the decimal text of a log: the values in memory equal those in a file.
    format!("{:.3}", (value / digit).round() * digit)
        .parse()
        .unwrap_or(value)
}
