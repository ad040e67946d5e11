//! An effect as data: its texts, its parameters, and a function that attaches it to a plant.

use hitch_plant::hooks::effect_hooks::{EffectHooks, RunConditions};
use hitch_plant::{Channel, Dynamics, Effect, Parameter, SizeResponse};

/// An effect of the catalogue; every field is the result of the method of [`Effect`] with the same name.
pub struct Described {
    pub(crate) id: &'static str,
    pub(crate) form: Option<&'static str>,
    pub(crate) title: &'static str,
    pub(crate) equation: &'static str,
    pub(crate) source: &'static str,
    pub(crate) shows: &'static str,
    pub(crate) parameters: &'static [Parameter],
    pub(crate) channels: &'static [Channel],
    pub(crate) needs: Option<Dynamics>,
    pub(crate) size_response: SizeResponse,
    pub(crate) refines: bool,
    pub(crate) attach: fn(&[f64], RunConditions<'_>, &mut EffectHooks),
}

impl Described {
    /// An effect without texts and parameters, in any model, with a smooth response.
    pub(crate) const USUAL: Self = Self {
        id: "",
        form: None,
        title: "",
        equation: "",
        source: "",
        shows: "",
        parameters: &[],
        channels: &Channel::ALL,
        needs: None,
        size_response: SizeResponse::Smooth,
        refines: false,
        attach: |_, _, _| {},
    };
}

/// Methods that return the field with their name.
macro_rules! fields {
    ($($name:ident: $kind:ty),* $(,)?) => {
        $(fn $name(&self) -> $kind {
            self.$name
        })*
    };
}

impl Effect for Described {
    fields! {
        id: &'static str,
        form: Option<&'static str>,
        title: &'static str,
        equation: &'static str,
        source: &'static str,
        shows: &'static str,
        parameters: &'static [Parameter],
        channels: &'static [Channel],
        needs: Option<Dynamics>,
        size_response: SizeResponse,
        refines: bool,
    }

    fn rank(&self) -> usize {
        crate::order::rank(self.id)
    }

    fn attach(&self, values: &[f64], conditions: RunConditions<'_>, hooks: &mut EffectHooks) {
        (self.attach)(values, conditions, hooks);
    }
}
