//! Timing error of a ringing pressure that follows from the position.
//!
//! A load rings on its oil with a frequency proportional to the reciprocal root of the oil's volume. The simulated position
//! is uncertain by the random walk of its flow, so the frequency is uncertain by half the relative error of the volume, and
//! the phase by an amount that grows from the last movement of a valve.

use hitch_plant::simulation::Trace;
use hitch_plant::{Channel, Model};

use crate::data::ready_run::ReadyRun;
use crate::data::regime::Regime;

/// One sigma of the time by which the ringing of a run's cylinder pressure is early or late at each sample, s, where the simulated
/// angle has these standard deviations, degree.
pub(crate) fn timing_errors_s(
    run: &ReadyRun,
    model: &Model,
    trace: &Trace,
    walk_deg: &[f64],
) -> Vec<f64> {
    let (cylinder, linkage) = (&model.constants().cylinder, model.linkage());
    let time_s = &run.drive.time_s;
    let angle_deg = trace.channel(Channel::RockerAngle);
    let mut late_s = 0.0;
    (0..run.len())
        .map(|sample| {
            if run.regimes[sample] == Regime::Switching || sample == 0 {
                late_s = 0.0;
                return late_s;
            }
            let angle_rad = angle_deg[sample].to_radians();
            let piston_m = linkage.piston_m(angle_rad);
            let error_m = walk_deg[sample].to_radians() / linkage.angle_slope_rad_m(angle_rad);
            let share = 0.5 * cylinder.area_m2() * error_m / cylinder.volume_m3(piston_m);
            late_s += share * (time_s[sample] - time_s[sample - 1]);
            late_s
        })
        .collect()
}
