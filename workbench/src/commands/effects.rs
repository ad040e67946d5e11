//! `hitch effects`: the catalogue of physical effects, and the elements of formulas.
mod catalogue;
mod formulas;

use std::fmt::Write as _;

pub use catalogue::Catalogue;
use hitch_plant::{Effect, Model, full_name};

use hitch_output::JsonArg;
use hitch_output::error::Error;
use hitch_output::targets::Outputs;
use hitch_output::text::{Table, indented, joined, wrapped};
use hitch_results::arguments::effect::find;
use hitch_results::arguments::model::ModelArg;

/// Arguments of `hitch effects`.
#[derive(Debug, clap::Args)]
#[command(
    after_help = "Examples:\n  hitch effects\n  hitch effects lower-threshold-shift\n  hitch effects --formulas\n  hitch effects --json - | jq '.effects[].id'"
)]
pub struct Args {
    /// Show only this effect, in full detail
    effect: Option<String>,
    /// List the places, signals and functions for formulas in a model file instead
    #[arg(long, conflicts_with = "effect")]
    formulas: bool,
    #[command(flatten)]
    model: ModelArg,
    #[command(flatten)]
    json: JsonArg,
}

/// Runs the command.
///
/// # Errors
/// If the effect is not in the catalogue, or the output cannot be written.
pub fn run(args: &Args) -> Result<(), Error> {
    if args.formulas {
        if args.json.target().is_some() {
            let what = "--formulas is a text for people; --json writes the effects";
            return Err(Error::Usage(what.to_owned()));
        }
        return hitch_output::print(&formulas::text());
    }
    let outputs = Outputs::check([args.json.target()], &[args.model.file()])?;
    let model = args.model.load()?;
    match &args.effect {
        None => {
            let catalogue = Catalogue::of(hitch_effects::available(&model).into_iter());
            outputs.tell(&args.json, &catalogue, || list(&model))
        }
        Some(id) => {
            let effect = find(&model, id)?;
            let catalogue = Catalogue::of(std::iter::once(effect));
            outputs.tell(&args.json, &catalogue, || card(effect))
        }
    }
}

fn list(model: &Model) -> String {
    let mut text = String::new();
    for effect in hitch_effects::available(model) {
        let name = full_name(effect);
        let _ = writeln!(text, "{}", wrapped(&format!("{name}: {}", effect.title())));
        let _ = writeln!(text, "{}", indented(effect.equation(), 4));
    }
    let hint = "hitch effects EFFECT shows all that is known of one; hitch effects --formulas what formulas of one's \
                own in a model file are made of.";
    format!("{text}\n{}\n", wrapped(hint))
}

/// Full description of an effect. (Writing to a string cannot fail.)
fn card(effect: &dyn Effect) -> String {
    let mut text = format!(
        "{}\n\n{}\n\n",
        wrapped(&format!("{}: {}", full_name(effect), effect.title())),
        indented(effect.equation(), 2)
    );
    let mut table = Table::new(["parameter", "unit", "off at", "often", "least", "greatest"]);
    for parameter in effect.parameters() {
        let numbers = [
            parameter.null,
            parameter.typical,
            parameter.low,
            parameter.high,
        ];
        let cells = [parameter.name, parameter.unit].map(str::to_owned);
        let cells = cells
            .into_iter()
            .chain(numbers.map(|number| number.to_string()));
        table.row(cells);
        table.note(parameter.meaning);
    }
    let channels = effect.channels().iter().map(|channel| channel.title());
    let _ = writeln!(text, "{table}");
    for (name, words) in [
        ("Source", effect.source()),
        ("Shows", effect.shows()),
        ("Channels", &joined(channels, ", ")),
    ] {
        let _ = writeln!(text, "{}", wrapped(&format!("{name}: {words}")));
    }
    let _ = writeln!(
        text,
        "\nIn a model file:\n\n  [[effect]]\n  id = \"{}\"",
        effect.id()
    );
    if let Some(form) = effect.form() {
        let _ = writeln!(text, "  form = \"{form}\"");
    }
    for parameter in effect.parameters() {
        let _ = writeln!(text, "  {} = {}", parameter.key, parameter.typical);
    }
    text
}

#[cfg(test)]
mod tests {
    use hitch_effects::CATALOGUE;

    use super::*;

    #[test]
    fn every_effect_has_a_card_that_its_model_file_matches() {
        for effect in CATALOGUE {
            let card = card(*effect);
            let block = card
                .split("In a model file:")
                .nth(1)
                .unwrap()
                .replace("\n  ", "\n");
            let text = format!("format = 1\nbase = \"nominal\"\n{block}");
            let source = hitch_input::source_file::SourceFile {
                path: "card.toml".into(),
                text,
            };
            let model = hitch_model_file::parse(&source).unwrap();
            assert_eq!(full_name(model.effects[0].effect), full_name(*effect));
        }
    }

    #[test]
    fn a_misspelt_effect_is_offered_its_neighbour() {
        let error = find(&hitch_model_file::nominal(), "coulomb-fricton")
            .unwrap_err()
            .to_string();
        assert!(error.contains("did you mean coulomb-friction?"), "{error}");
    }
}
