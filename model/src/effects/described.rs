//! An effect as data: its texts, its parameters, and a function that puts it into a plant.

use super::{Effect, Parameter, Search};
use crate::campaign::Channel;
use crate::model::Dynamics;
use crate::plant::sites::{RunConditions, Sites};

/// An effect of the catalogue; every field is what the method of [`Effect`] of that name gives.
pub struct Described {
    pub(super) id: &'static str,
    pub(super) form: Option<&'static str>,
    pub(super) title: &'static str,
    pub(super) equation: &'static str,
    pub(super) source: &'static str,
    pub(super) shows: &'static str,
    pub(super) parameters: &'static [Parameter],
    pub(super) channels: &'static [Channel],
    pub(super) needs: Option<Dynamics>,
    pub(super) search: Search,
    pub(super) refines: bool,
    pub(super) attach: fn(&[f64], RunConditions<'_>, &mut Sites),
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

    fn needs(&self) -> Option<Dynamics> {
        self.needs
    }

    fn search(&self) -> Search {
        self.search
    }

    fn refines(&self) -> bool {
        self.refines
    }

    fn attach(&self, values: &[f64], conditions: RunConditions<'_>, sites: &mut Sites) {
        (self.attach)(values, conditions, sites);
    }
}
