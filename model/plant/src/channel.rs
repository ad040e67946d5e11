//! The measured outputs of the plant.

/// A measured output.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Channel {
    /// Pressure between pump and valve block, bar.
    PumpPressure,
    /// Pressure between valve block and cylinder, bar.
    CylinderPressure,
    /// Flow between valve block and cylinder, positive into the cylinder, l/min.
    Flow,
    /// Angle of the rocker arm, degrees; 90 is straight down, it grows as the hitch rises.
    RockerAngle,
}

impl Channel {
    /// Every channel, in the order of [`Channel::index`].
    pub const ALL: [Self; 4] = [
        Self::PumpPressure,
        Self::CylinderPressure,
        Self::Flow,
        Self::RockerAngle,
    ];

    /// Column name in logs and key in JSON.
    pub const fn key(self) -> &'static str {
        match self {
            Self::PumpPressure => "pump_pressure_bar",
            Self::CylinderPressure => "cylinder_pressure_bar",
            Self::Flow => "flow_lpm",
            Self::RockerAngle => "rocker_angle_deg",
        }
    }

    /// Display name.
    pub const fn title(self) -> &'static str {
        match self {
            Self::PumpPressure => "pump pressure",
            Self::CylinderPressure => "cylinder pressure",
            Self::Flow => "flow",
            Self::RockerAngle => "rocker angle",
        }
    }

    /// Unit of the values.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::PumpPressure | Self::CylinderPressure => "bar",
            Self::Flow => "l/min",
            Self::RockerAngle => "deg",
        }
    }

    /// Index in arrays over all channels.
    pub const fn index(self) -> usize {
        self as usize
    }
}

#[cfg(test)]
mod tests {
    use super::Channel;

    #[test]
    fn index_is_the_place_in_all() {
        for (place, channel) in Channel::ALL.into_iter().enumerate() {
            assert_eq!(channel.index(), place);
        }
    }
}
