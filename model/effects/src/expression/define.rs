//! A term from its definition: parsed, checked and compiled.

use hitch_input::fault::shown;
use hitch_input::{Dimension, Unit};
use hitch_plant::Place;

use crate::expression::definition::{Part, TermDefinition, TermError, check_id, check_parameters};
use crate::expression::evaluate::Code;
use crate::expression::parse::parse;
use crate::expression::term::Term;
use crate::expression::tree::{Kind, Node};
use crate::expression::{check, probe};

impl Term {
    /// Checks a definition and compiles its formula.
    ///
    /// # Errors
    /// The first fault: a name, a unit, a range, the syntax, the dimensions, an unused parameter, a value that is not
    /// finite, or a null value at which the term is not zero.
    pub fn new(definition: TermDefinition) -> Result<Self, TermError> {
        check_id(&definition.id)?;
        let units = check_parameters(&definition.parameters)?;
        let formula = definition.formula.as_str();
        let names: Vec<&str> = definition
            .parameters
            .iter()
            .map(|p| p.name.as_str())
            .collect();
        let tree = parse(formula, &names)?;
        let dimensions: Vec<Dimension> = units.iter().map(|unit| unit.dimension).collect();
        check_place(
            definition.place,
            check::dimension(&tree, formula, &dimensions)?,
        )?;
        check_use(&tree, &names)?;
        let code = Code::compile(&tree);
        let term = Self {
            definition,
            units,
            code,
        };
        probe::check(&term, &tree)?;
        Ok(term)
    }
}

fn check_place(place: Place, found: Dimension) -> Result<(), TermError> {
    let wanted = Unit::parse(place.unit()).map_or(Dimension::NUMBER, |unit| unit.dimension);
    if found == wanted {
        return Ok(());
    }
    let what = format!(
        "the formula is {}, but {} takes {}",
        found.in_words(),
        place.id(),
        wanted.in_words()
    );
    let hint = match wanted.over(found) {
        Some(factor) => {
            format!("multiply it by something in {factor}")
        }
        None => format!("write a formula in {wanted}"),
    };
    Err(TermError::new(Part::Formula(0), what, hint))
}

fn check_use(tree: &Node, names: &[&str]) -> Result<(), TermError> {
    let unused = (0..names.len())
        .find(|index| !tree.has(&|leaf| matches!(leaf, Kind::Parameter(used) if used == index)));
    unused.map_or(Ok(()), |index| {
        let what = format!(
            "the formula does not contain the parameter {}",
            shown(names[index])
        );
        Err(TermError::new(
            Part::Parameter(index, "name"),
            what,
            "use it or delete it",
        ))
    })
}
