//! `hitch effects`: the catalogue of physical effects.
use std::fmt::Write as _;

use hitch_model::effects::{self, CATALOGUE, Effect};
use hitch_model::naming::offer_names;

use crate::error::Error;
use crate::output;
use crate::text::{Table, wrapped};

/// Arguments of `hitch effects`.
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:\n  hitch effects\n  hitch effects lower-threshold-shift")]
pub struct Args {
    /// Show this effect only, with all that is known of it
    effect: Option<String>,
}

/// Runs the command.
///
/// # Errors
/// If the effect is not in the catalogue.
pub fn run(args: &Args) -> Result<(), Error> {
    match &args.effect {
        None => output::print(&list()),
        Some(id) => output::print(&card(find(id)?)),
    }
}

/// Looks up an effect that a user named.
///
/// # Errors
/// If it is not in the catalogue; the nearest name is offered.
pub fn find(id: &str) -> Result<&'static dyn Effect, Error> {
    effects::find(id).ok_or_else(|| {
        let known: Vec<&str> = CATALOGUE.iter().map(|effect| effect.id()).collect();
        Error::Usage(format!(
            "effect {id:?} is not known; {}",
            offer_names(id, &known)
        ))
    })
}

fn list() -> String {
    let mut text = String::new();
    for effect in CATALOGUE {
        let _ = writeln!(
            text,
            "{:<24} {}\n{:24} {}",
            effect.id(),
            effect.title(),
            "",
            effect.equation()
        );
    }
    text + "\nhitch effects EFFECT shows all that is known of one.\n"
}

/// All that is known of an effect. (Writing to a string cannot fail, so the results are dropped.)
fn card(effect: &dyn Effect) -> String {
    let mut text = format!(
        "{}: {}\n\n  {}\n\n",
        effect.id(),
        effect.title(),
        effect.equation()
    );
    let mut table = Table::new([
        "parameter",
        "unit",
        "off at",
        "often",
        "least",
        "greatest",
        "meaning",
    ]);
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
        table.row(cells.chain([parameter.meaning.to_owned()]));
    }
    let channels: Vec<&str> = effect
        .channels()
        .iter()
        .map(|channel| channel.title())
        .collect();
    let _ = writeln!(text, "{table}");
    for (name, words) in [
        ("Source", effect.source()),
        ("Shows", effect.shows()),
        ("Channels", &channels.join(", ")),
    ] {
        let _ = writeln!(text, "{}", wrapped(&format!("{name}: {words}"), 100));
    }
    let _ = writeln!(
        text,
        "\nIn a model file:\n\n  [[effect]]\n  id = \"{}\"",
        effect.id()
    );
    for parameter in effect.parameters() {
        let _ = writeln!(text, "  {} = {}", parameter.key, parameter.typical);
    }
    text
}

#[cfg(test)]
mod tests {
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
            let source = hitch_model::source_file::SourceFile {
                path: "card.toml".into(),
                text,
            };
            let model = hitch_model::Model::from_source(&source).unwrap();
            assert_eq!(model.effects[0].effect.id(), effect.id());
        }
    }

    #[test]
    fn a_misspelt_effect_is_offered_its_neighbour() {
        let error = find("coulomb-fricton").unwrap_err().to_string();
        assert!(error.contains("did you mean coulomb-friction?"), "{error}");
    }
}
