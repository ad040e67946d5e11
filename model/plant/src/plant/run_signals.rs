//! The signals that are constant over a run.

use crate::components::oil;
use crate::hooks::signals::Signals;
use crate::state::Rig;

/// The signals that are constant over a run.
pub(crate) fn signals_of_run(rig: Rig, oil_temperature_c: f64) -> Signals {
    let run = Signals {
        oil_temperature_c,
        viscosity_m2_s: oil::viscosity_m2_s(oil_temperature_c),
        ..Signals::default()
    };
    match rig {
        Rig::Hitch(rig) => Signals {
            load_kg: rig.load_kg,
            ..run
        },
        Rig::Flow { .. } => Signals {
            travel_m: f64::NAN,
            speed_m_s: f64::NAN,
            rocker_angle_rad: f64::NAN,
            load_kg: f64::NAN,
            weight_n: f64::NAN,
            ..run
        },
    }
}
