//! Errors of linkage dimensions, and the constants that may correct them.

/// Reason why dimensions do not form a linkage.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum LinkageError {
    /// The rocker cannot sweep the cylinder's stroke.
    #[error(
        "a rocker arm of {rocker_arm_m} m with a connecting rod of {connecting_rod_m} m sweeps {most_m:.3} m at most, \
         less than the stroke of {stroke_m} m"
    )]
    Stroke {
        /// Rocker arm, m.
        rocker_arm_m: f64,
        /// Connecting rod, m.
        connecting_rod_m: f64,
        /// Stroke, m.
        stroke_m: f64,
        /// Largest sweep, symmetric about straight down, m.
        most_m: f64,
    },
    /// The connecting rod does not reach from the rocker to the cylinder's axis.
    #[error(
        "the connecting rod of {connecting_rod_m} m does not reach the cylinder's axis, {rise_m:.3} m from the rocker's \
         end at an angle of {rocker_angle_deg:.1} degrees"
    )]
    ConnectingRod {
        /// Connecting rod, m.
        connecting_rod_m: f64,
        /// Distance across that it has to span, m.
        rise_m: f64,
        /// Rocker angle at which it does not reach, degrees.
        rocker_angle_deg: f64,
    },
    /// The lift rod does not join the lift arm to the lower link.
    #[error(
        "the lift rod of {lift_rod_m} m cannot join the lift arm's end to the lower link's joint at a rocker angle of \
         {rocker_angle_deg:.1} degrees"
    )]
    LiftRod {
        /// Lift rod, m.
        lift_rod_m: f64,
        /// Shortest rod that would join at this angle, m.
        least_m: f64,
        /// Longest rod that would join at this angle, m.
        most_m: f64,
        /// Rocker angle at which it does not join, degrees.
        rocker_angle_deg: f64,
    },
    /// The measured linkage does not cover the stroke.
    #[error(
        "the measured linkage covers {:.1} to {:.1} mm, not the stroke of 0 to {:.1} mm",
        1e3 * .first_m, 1e3 * .last_m, 1e3 * .stroke_m
    )]
    Table {
        /// First travel, m.
        first_m: f64,
        /// Last travel, m.
        last_m: f64,
        /// Stroke, m.
        stroke_m: f64,
    },
}

/// A constant of a model file: its table and its key.
pub type Key = (&'static str, &'static str);

impl LinkageError {
    /// The constants that may be wrong, the most probable first.
    #[must_use]
    pub const fn keys(&self) -> &'static [Key] {
        match self {
            Self::Stroke { .. } => &[
                ("cylinder", "stroke_mm"),
                ("linkage", "rocker_arm_m"),
                ("linkage", "connecting_rod_m"),
                ("linkage", "cylinder_axis_y_m"),
            ],
            Self::ConnectingRod { .. } => &[
                ("linkage", "connecting_rod_m"),
                ("linkage", "cylinder_axis_y_m"),
                ("linkage", "rocker_arm_m"),
            ],
            Self::LiftRod { .. } => &[
                ("linkage", "lift_rod_m"),
                ("linkage", "lift_rod_joint_m"),
                ("linkage", "lift_arm_m"),
                ("linkage", "pivot_x_m"),
                ("linkage", "pivot_y_m"),
            ],
            Self::Table { .. } => &[("linkage", "stroke_mm"), ("cylinder", "stroke_mm")],
        }
    }

    /// Suggested correction.
    #[must_use]
    pub fn hint(&self) -> String {
        match self {
            Self::Stroke { most_m, .. } => format!(
                "let stroke_mm of [cylinder] be less than {:.0}, or rocker_arm_m of [linkage] longer",
                (1e3 * most_m).floor()
            ),
            Self::ConnectingRod { rise_m, .. } => format!(
                "let connecting_rod_m of [linkage] be more than {rise_m:.3}, or cylinder_axis_y_m nearer to the rocker"
            ),
            Self::LiftRod {
                least_m, most_m, ..
            } => format!(
                "let lift_rod_m of [linkage] be between {least_m:.3} and {most_m:.3}, or check its joints: \
                 lift_rod_joint_m, lift_arm_m, pivot_x_m, pivot_y_m"
            ),
            Self::Table { .. } => {
                "measure from the retracted piston to the end of its stroke, or correct stroke_mm of [cylinder]".to_owned()
            }
        }
    }
}
