//! Position control, draft, mix and depth limit on the same soil, means of several seeds, with the crossover, the smallest step
//! and the lag's length of the draft loop: `cargo run -p host-tests --example draft-control -- 8 300 4500 1500`.

use hitch_quantities::Function;
use hitch_results::field_loop::pass::{Comparison, fitted_with};

fn main() {
    let number = |index: usize| {
        let text = std::env::args().nth(index)?;
        Some(text.parse().expect("a number"))
    };
    let calibration = fitted_with(|calibration| {
        let draft = &mut calibration.draft;
        draft.crossover.0 = number(2).unwrap_or(draft.crossover.0);
        draft.step.0 = number(3).unwrap_or(draft.step.0);
        draft.length.0 = number(4).unwrap_or(draft.length.0);
    });
    let seeds = u64::from(number(1).unwrap_or(4).unsigned_abs());
    for function in [Function::Draft, Function::Mix, Function::DepthLimit] {
        println!(
            "{}",
            Comparison::of(
                &hitch_model_file::dynamic(),
                function,
                &calibration,
                1..=seeds
            )
        );
    }
}
