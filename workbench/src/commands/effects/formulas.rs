//! Lists the elements of formulas in a model file.

use std::fmt::Write as _;

use hitch_effects::expression::operation::FUNCTIONS;
use hitch_plant::Place;
use hitch_plant::hooks::signals::SIGNALS;

use hitch_output::text::Table;

const HEAD: &str = "\
A term of your own in a model file is fitted, added and reported like an effect
of the catalogue:

  [[term]]
  id = \"end-cushion\"
  place = \"lower-flow-factor\"
  formula = \"-share * ramp(1 - x / depth)\"

  [[term.parameter]]
  name = \"share\"
  null = 0
  start = 0.5
  low = 0
  high = 1

  [[term.parameter]]
  name = \"depth\"
  unit = \"mm\"
  start = 40
  low = 5
  high = 150

The first parameter is the size: at its null value the term has to be zero.
Inside everything is SI and the units are checked; a number takes a unit as in
3[mm/s]. Operators: + - * / ^ and parentheses. hitch effects --model FILE lists
the terms of a file.
";

/// Places, signals and functions. (Writing to a string cannot fail.)
pub fn text() -> String {
    let mut text = HEAD.to_owned();
    let places = Place::all();
    let places = places.map(|place| [place.id(), place.unit(), place.meaning()].map(str::to_owned));
    let places = Table::of(["place", "unit", "action of a term"], places);
    let signals = SIGNALS.iter();
    let signals = signals.map(|one| [one.name, one.unit, one.meaning].map(str::to_owned));
    let signals = Table::of(["signal", "unit", "description"], signals);
    let _ = write!(text, "\n{places}\n{signals}\n  function\n");
    for (_, _, meaning) in FUNCTIONS {
        let _ = writeln!(text, "  {meaning}");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_example_is_a_model_file() {
        let term = HEAD.split("\n\n").skip(1).take(3).collect::<Vec<_>>();
        let source = hitch_input::source_file::SourceFile {
            path: "term.toml".into(),
            text: format!("format = 1\nbase = \"nominal\"\n{}", term.join("\n")),
        };
        let model = hitch_model_file::parse(&source).unwrap();
        assert_eq!(model.terms.len(), 1);
    }

    #[test]
    fn every_name_is_listed() {
        let text = text();
        for name in Place::all().map(Place::id) {
            assert!(text.contains(name), "{name}");
        }
        for (name, ..) in FUNCTIONS {
            assert!(text.contains(&format!("{name}(")), "{name}");
        }
    }
}
