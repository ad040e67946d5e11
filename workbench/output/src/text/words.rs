//! Plain words for the terms of results: the one source of them for texts, reports and the page.
//!
//! `docs/GLOSSARY.md` defines the terms; these say what a reader of a result needs.

use hitch_plant::{Dynamics, Model};
use schemars::JsonSchema;
use serde::Serialize;

use super::joined;

/// A term and what it means.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Word {
    /// The term as it is written beside a figure.
    pub term: &'static str,
    /// Its meaning, a phrase without a full stop.
    pub means: &'static str,
}

/// The unit of errors.
pub const SIGMA: Word = Word {
    term: "σ",
    means: "standard deviation of the noise of the instrument: at 1 σ, the error is that noise alone",
};

/// The share of the error that an effect explains.
pub const EXPLAINS: Word = Word {
    term: "explains",
    means: "share of the squared error above the noise that vanishes with the effect",
};

/// The probability of an effect.
pub const CONFIDENCE: Word = Word {
    term: "confidence",
    means: "probability that the effect is in the machine, 0 to 1; the 95 % interval is about its size if it is",
};

/// The size of a signature.
pub const DETECTABILITY: Word = Word {
    term: "detectability",
    means: "how much the measurement changes in a way that only this effect does, root mean square in σ; below 1 it is easily missed",
};

/// The error on runs that a fit did not use.
pub const HELD_OUT: Word = Word {
    term: "held-out",
    means: "error on runs that were not used for the fit",
};

/// The angle between two signatures.
pub const ANGLE: Word = Word {
    term: "angle",
    means: "how differently two effects change the measurement: 0 deg alike, 90 deg nothing in common",
};

/// An effect of the model before a search.
pub const ADOPTED: Word = Word {
    term: "adopted",
    means: "in the model before the search, which may change its size",
};

/// Every term, for a list.
pub const ALL: [Word; 7] = [
    SIGMA,
    EXPLAINS,
    CONFIDENCE,
    DETECTABILITY,
    HELD_OUT,
    ANGLE,
    ADOPTED,
];

/// Terms with their meanings as sentences.
#[must_use]
pub fn sentences(words: &[Word]) -> String {
    let sentence = |word: &Word| {
        let mut letters = word.term.chars();
        let first = letters.next().map(|letter| {
            if letter.is_ascii() {
                letter.to_ascii_uppercase()
            } else {
                letter
            }
        });
        let term: String = first.into_iter().chain(letters).collect();
        format!("{term}: {}.", word.means)
    };
    joined(words.iter().map(sentence), " ")
}

/// A probability in words.
#[must_use]
pub fn in_words(confidence: f64) -> &'static str {
    match confidence {
        share if share >= 0.95 => "nearly certain",
        share if share >= 0.7 => "likely",
        share if share >= 0.3 => "possible",
        share if share >= 0.005 => "unlikely",
        _ => "very unlikely",
    }
}

/// A probability in words and as a percentage: beside a 95 % interval, a bare number is taken for one.
#[must_use]
pub fn probable(confidence: f64) -> String {
    format!("{}, {:.0} %", in_words(confidence), 100.0 * confidence)
}

/// The name of a model with the kind of its plant: `nominal` alone says nothing of it.
#[must_use]
pub fn named(model: &Model) -> String {
    let kind = match model.constants().dynamics {
        Dynamics::Steady => "no inertia, stiff oil",
        Dynamics::Dynamic => "with inertia and compressible oil",
    };
    format!("{} ({kind})", model.name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_term_stands_in_the_glossary() {
        let glossary = include_str!("../../../../docs/GLOSSARY.md").to_lowercase();
        for word in ALL {
            assert!(glossary.contains(word.term), "{}", word.term);
        }
    }

    #[test]
    fn a_list_is_sentences() {
        assert!(sentences(&[HELD_OUT, SIGMA]).starts_with("Held-out: error on runs"));
        assert!(sentences(&[SIGMA]).starts_with("σ: standard") && sentences(&ALL).ends_with('.'));
    }

    #[test]
    fn the_kind_of_a_model_is_said() {
        assert_eq!(
            named(&hitch_model_file::nominal()),
            "nominal (no inertia, stiff oil)"
        );
    }
}
