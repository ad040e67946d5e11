//! Converts a suggested term into its display form.

use hitch_identification::suggestion::Suggestion;
use hitch_model_file::term_text;

use super::{Suggested, Unexplained, parameters};

impl Suggested {
    fn new(found: &Suggestion) -> Self {
        let definition = found.term.term().definition();
        Self {
            place: definition.place.id(),
            formula: definition.formula.clone(),
            parameters: parameters(found.term, &found.values, &found.intervals),
            held_out_before: found.held_out_before.error,
            held_out_after: found.held_out_after.error,
            error_after: found.fit.error(),
            replaces: found.unneeded.iter().map(|effect| effect.id()).collect(),
            model_file: term_text(found.term),
        }
    }
}

impl Unexplained {
    /// Adds a suggestion.
    pub fn suggest(&mut self, found: &Suggestion) {
        let suggested = Suggested::new(found);
        self.suggested_term = Some(format!("{} = {}", suggested.place, suggested.formula));
        self.suggested = Some(suggested);
    }
}
