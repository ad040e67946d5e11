//! Position control, depth limit and depth control over an undulation and on level ground, with the crossover, the smallest step,
//! the dead band, the low-pass and the depth per degree of the depth loop:
//! `cargo run -p host-tests --example depth-control -- 4 300 1500 14000 3200 9000`.

use hitch_closed_loop::field::{LINK_DEPTH_M, Settings};
use hitch_field::draft::Texture;
use hitch_field::soil::SoilPlan;
use hitch_quantities::Function;
use hitch_quantities::units::Count;
use hitch_results::field_loop::pass::{DEPTH_M, DRAFT_N, Pass, fitted_with};
use hitch_results::field_loop::undulation::{DepthFigures, drive};

fn main() {
    let number = |index: usize| {
        let text = std::env::args().nth(index)?;
        Some(text.parse().expect("a number"))
    };
    let calibration = fitted_with(|calibration| {
        let depth = &mut calibration.depth;
        depth.fitted = Count(1);
        depth.crossover.0 = number(2).unwrap_or(depth.crossover.0);
        depth.step.0 = number(3).unwrap_or(depth.step.0);
        depth.dead_band.0 = number(4).unwrap_or(depth.dead_band.0);
        depth.filter.0 = number(5).unwrap_or(depth.filter.0);
        depth.per_degree.0 = number(6).unwrap_or(depth.per_degree.0);
    });
    let model = hitch_model_file::dynamic();
    for function in [Function::Position, Function::DepthLimit, Function::Depth] {
        let settings = Settings {
            function,
            draft_n: Some(DRAFT_N),
            depth_m: Some(DEPTH_M),
            ..Settings::default()
        };
        for seed in 1..=number(1).unwrap_or(4).unsigned_abs().into() {
            let level = Pass {
                soil: SoilPlan::varying(Texture::Medium),
                settings,
                link_depth_m: LINK_DEPTH_M,
                work_s: 60.0,
                seed,
            };
            let waves = drive(&model, &calibration, &settings, seed, |_, _| {});
            let level = level.drive(&model, &calibration, |_, _| {});
            for (ground, samples) in [("waves", waves), ("level", level)] {
                let found = DepthFigures::of(&samples);
                println!(
                    "{:<11} {ground} mean {:.1} cm, deviation {:.2} cm, {:.0} % of the way beyond 10 %, {:.1} % out of the ground; {:.0} activations a minute",
                    format!("{function:?}"),
                    found.depth_m.mean * 100.0,
                    found.depth_m.deviation * 100.0,
                    found.beyond * 100.0,
                    found.out * 100.0,
                    found.activations_per_min
                );
            }
        }
    }
}
