//! The log of a simulated run.

use std::fmt::Write as _;

use hitch_campaign::Run;
use hitch_plant::{Channel, Currents, Model, Plant, Reading, Rig};

/// The log with simulated instead of measured channels. (Writing to a string cannot fail.)
pub fn simulated(model: &Model, rig: Rig, log: &Run) -> String {
    let channels: Vec<Channel> = Channel::ALL
        .into_iter()
        .filter(|channel| can_show(rig, *channel))
        .collect();
    let keys: Vec<&str> = channels.iter().map(|channel| channel.key()).collect();
    let mut text = format!("time_s,lift_current_a,lower_current_a,{}\n", keys.join(","));
    let currents = |i: usize| Currents {
        lift_a: log.lift_current_a[i],
        lower_a: log.lower_current_a[i],
    };
    let mut plant = Plant::new(model, rig, log.oil_temperature_c, currents(0));
    for i in 0..log.time_s.len() {
        if i > 0 {
            plant.step(currents(i), log.time_s[i] - log.time_s[i - 1]);
        }
        let Currents { lift_a, lower_a } = currents(i);
        let _ = write!(text, "{},{lift_a},{lower_a}", log.time_s[i]);
        write_reading(&mut text, &plant.reading(), &channels);
    }
    text
}

fn write_reading(text: &mut String, reading: &Reading, channels: &[Channel]) {
    for channel in channels {
        let _ = write!(text, ",{:.5}", reading.channel(*channel) + 0.0);
    }
    text.push('\n');
}

fn can_show(rig: Rig, channel: Channel) -> bool {
    channel != Channel::RockerAngle || matches!(rig, Rig::Hitch(_))
}
