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

impl Effect for Described {
    fn id(&self) -> &'static str {
        self.id
    }

    fn form(&self) -> Option<&'static str> {
        self.form
    }

    fn title(&self) -> &'static str {
        self.title
    }

    fn equation(&self) -> &'static str {
        self.equation
    }

    fn source(&self) -> &'static str {
        self.source
    }

    fn shows(&self) -> &'static str {
        self.shows
    }

    fn parameters(&self) -> &'static [Parameter] {
        self.parameters
    }

    fn channels(&self) -> &'static [Channel] {
        self.channels
    }

    fn rank(&self) -> usize {
        crate::order::rank(self.id)
    }

    fn needs(&self) -> Option<Dynamics> {
        self.needs
    }

    fn size_response(&self) -> SizeResponse {
        self.size_response
    }

    fn refines(&self) -> bool {
        self.refines
    }

    fn attach(&self, values: &[f64], conditions: RunConditions<'_>, hooks: &mut EffectHooks) {
        (self.attach)(values, conditions, hooks);
    }
}
