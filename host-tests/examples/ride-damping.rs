//! Ride damping against a hitch that holds, by tractor, road and speed, and by what its parts bring.
//!
//! `cargo run --release -p host-tests --example ride-damping [seeds]`

use hitch_field::body::BodyConstants;
use hitch_field::terrain::RoughnessConstants;
use hitch_quantities::Calibration;
use hitch_quantities::units::{MicrometrePerSecond, Millisecond, PerMille};
use hitch_results::field_loop::transport::{Ride, RideComparison, class_c, damping_with};

/// A change of the calibration that takes a part away.
type Ablation = (&'static str, fn(&mut Calibration));

const ABLATIONS: [Ablation; 4] = [
    ("without forcing of the spools", |c| {
        c.ride.forcing = PerMille(0)
    }),
    ("without lead", |c| c.ride.lead = Millisecond(0)),
    ("without dead band", |c| {
        c.ride.dead_band = MicrometrePerSecond(0)
    }),
    ("half of the gain", |c| c.ride.gain.0 /= 2),
];

fn main() {
    let seeds = std::env::args()
        .nth(1)
        .and_then(|text| text.parse().ok())
        .unwrap_or(5);
    let bodies = [
        ("4.5 t", BodyConstants::ploughing()),
        ("1.6 t", BodyConstants::published_light()),
    ];
    let roads = [("C", class_c()), ("D", RoughnessConstants::class_d())];
    for (tractor, body) in &bodies {
        for (class, roughness) in &roads {
            for km_h in [12.0, 20.0] {
                let ride = Ride {
                    body: body.clone(),
                    roughness: roughness.clone(),
                    speed_m_s: km_h / 3.6,
                };
                let found = RideComparison::of(
                    &hitch_model_file::dynamic(),
                    &ride,
                    &damping_with(|_| {}),
                    1..=seeds,
                );
                println!("{tractor}, class {class}, {km_h} km/h: {found}");
            }
        }
    }
    let ride = Ride {
        body: BodyConstants::ploughing(),
        roughness: class_c(),
        speed_m_s: 20.0 / 3.6,
    };
    for (name, change) in ABLATIONS {
        let found = RideComparison::of(
            &hitch_model_file::dynamic(),
            &ride,
            &damping_with(change),
            1..=seeds,
        );
        println!("4.5 t, class C, 20 km/h, {name}: {found}");
    }
}
