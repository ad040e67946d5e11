//! A model with the estimated effects, as written to a file.

use std::path::Path;

use hitch_identification::estimate::Estimate;
use hitch_plant::Model;

/// Significant digits of an estimate in a model file; estimates are never more accurate.
const DIGITS: usize = 6;

/// The model with the effects and constants of an estimate and with another name; sizes of effects are rounded to
/// significant digits.
pub fn rebuilt(model: &Model, estimate: &Estimate, name: String) -> Model {
    let effects = estimate.effects.iter().cloned().map(|mut added| {
        added
            .values
            .iter_mut()
            .for_each(|value| *value = rounded(*value));
        added
    });
    let mut rebuilt = estimate.applied_to(model).with_effects(effects.collect());
    rebuilt.name = name;
    rebuilt
}

/// Writes each better estimate of a search as a model to a file, so that the best result so far is on disk if the search is
/// interrupted. Nothing is written without a file, or to standard output.
pub fn saving<'a>(base: &Model, out: Option<&'a Path>) -> impl Fn(&Estimate) + Sync + use<'a> {
    let (base, out) = (
        base.clone(),
        out.filter(|path| !hitch_output::is_stdout(path)),
    );
    move |estimate| {
        if let Some(path) = out {
            let partial = rebuilt(&base, estimate, hitch_output::stem(path));
            // A fault is reported by the last write.
            let _ = hitch_output::write_file(path, hitch_model_file::to_toml(&partial).as_bytes());
        }
    }
}

fn rounded(value: f64) -> f64 {
    let last = DIGITS - 1;
    format!("{value:.last$e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::rounded;

    #[test]
    fn estimates_keep_six_digits() {
        assert_eq!(rounded(0.198_670_368_832), 0.198_670);
        assert_eq!(rounded(-723.482_402), -723.482);
        assert_eq!(rounded(0.0), 0.0);
    }
}
