//! Motion that a fault costs: beyond what the same hitch does on the same soil without the fault.

use hitch_closed_loop::field::FieldSample;

/// What a fault moves, degrees.
#[derive(Clone, Copy, Debug, Default)]
pub struct Motion {
    /// Largest distance from the angle at the fault.
    pub whole_deg: f64,
    /// Largest distance beyond the angles that the hitch without the fault has had between the fault and that time.
    pub beyond_deg: f64,
}

impl Motion {
    /// Of a hitch with a fault from sample `from` on, and of its twin without it.
    pub fn of(faulty: &[FieldSample], healthy: &[FieldSample], from: usize) -> Self {
        let angle_deg = |sample: &FieldSample| sample.hitch.angle_deg;
        let start_deg = angle_deg(&faulty[from - 1]);
        let mut motion = Self::default();
        let (mut lowest_deg, mut highest_deg) = (start_deg, start_deg);
        for (faulty, healthy) in faulty.iter().zip(healthy).skip(from) {
            let (faulty_deg, healthy_deg) = (angle_deg(faulty), angle_deg(healthy));
            lowest_deg = lowest_deg.min(healthy_deg);
            highest_deg = highest_deg.max(healthy_deg);
            let beyond_deg = (lowest_deg - faulty_deg).max(faulty_deg - highest_deg);
            motion = motion.max(Self {
                whole_deg: (faulty_deg - start_deg).abs(),
                beyond_deg,
            });
        }
        motion
    }

    /// The larger ones of both.
    pub fn max(self, other: Self) -> Self {
        Self {
            whole_deg: self.whole_deg.max(other.whole_deg),
            beyond_deg: self.beyond_deg.max(other.beyond_deg),
        }
    }
}
