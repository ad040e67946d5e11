//! Command line arguments that constrain the drawn cases.

use clap::Args;

use super::draw::{Kind, Wish};
use super::hidden::{Fidelity, Hideable};
use super::hideable::find;
use super::manoeuvres::Plan;
use super::test_stand::Family;

/// Constraints of the drawn cases; the rest is drawn.
#[derive(Debug, Clone, Args)]
pub struct WishArguments {
    /// The effect to hide, by its id
    #[arg(long, visible_alias = "only", value_name = "EFFECT", value_parser = effect)]
    effect: Option<&'static Hideable>,
    /// Its size, in its unit
    #[arg(long, requires = "effect", allow_negative_numbers = true)]
    size: Option<f64>,
    /// Kind of the hidden effects if no effect is given
    #[arg(long, value_enum)]
    kind: Option<Kind>,
    /// How true to the textbook the hidden effects are
    #[arg(long, value_enum)]
    fidelity: Option<Fidelity>,
    /// Whether noise is slow, weights are wrong and unnamed physics is about
    #[arg(long)]
    rough: Option<bool>,
}

fn effect(id: &str) -> Result<&'static Hideable, String> {
    find(id).ok_or_else(|| "no such effect".to_owned())
}

impl WishArguments {
    /// The wish for a family and a plan, effects drawn from those of the catalogue.
    #[must_use]
    pub fn wish(&self, family: Family, plan: Plan) -> Wish {
        Wish {
            family,
            plan,
            fidelity: self.fidelity,
            rough: self.rough,
            kind: self.kind,
            effect: self.effect.map(|what| (what, self.size)),
            known: |id| hitch_effects::find(id).is_some(),
        }
    }

    /// The arguments again, as they would be typed.
    #[must_use]
    pub fn typed(&self) -> String {
        let lower = |text: String| text.to_lowercase();
        let mut typed = String::new();
        let mut add = |name: &str, value: Option<String>| {
            if let Some(value) = value {
                typed += &format!(" --{name} {value}");
            }
        };
        add("effect", self.effect.map(|what| what.id.to_owned()));
        add("size", self.size.map(|size| size.to_string()));
        add("kind", self.kind.map(|kind| lower(format!("{kind:?}"))));
        add(
            "fidelity",
            self.fidelity.map(|fidelity| lower(format!("{fidelity:?}"))),
        );
        add("rough", self.rough.map(|rough| rough.to_string()));
        typed
    }
}
