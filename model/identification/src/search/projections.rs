//! Nuisance projections for sets of effects: the parameters that are free at the present fit and belong to the set.

use std::sync::OnceLock;

use hitch_plant::is_same;

use crate::estimate::{Estimate, Shared};
use crate::estimation::jacobian::Jacobian;
use crate::estimation::nuisance_projection::NuisanceProjection;

/// The projections for sets that share effects with the present fit.
pub(crate) struct Projections<'a> {
    jacobian: &'a Jacobian,
    present: &'a Estimate,
    /// One projection per subset of the free effects of the present fit; bit `i` of the index stands for `free[i]`.
    projections: Vec<OnceLock<NuisanceProjection<&'a Jacobian>>>,
    /// Indices of the effects that are free at the present fit.
    free: Vec<usize>,
}

impl<'a> Projections<'a> {
    /// Projections of the sensitivities at the present fit.
    pub fn new(jacobian: &'a Jacobian, present: &'a Estimate) -> Self {
        let free: Vec<usize> = present.changed().collect();
        Self {
            projections: (0..1usize << free.len()).map(|_| OnceLock::new()).collect(),
            jacobian,
            present,
            free,
        }
    }

    /// The projection for residuals of an estimate. Effects of the present fit that the estimate lacks are not
    /// projected out.
    pub fn of(&self, estimate: &Estimate) -> &NuisanceProjection<&'a Jacobian> {
        let has = |&index: &usize| {
            let own = self.present.effects[index].effect;
            (0..estimate.effects.len()).any(|other| {
                is_same(estimate.effects[other].effect, own) && !estimate.is_unchanged(other)
            })
        };
        let bits = self.free.iter().enumerate();
        let subset = bits
            .map(|(bit, index)| usize::from(has(index)) << bit)
            .sum::<usize>();
        self.projections[subset].get_or_init(|| {
            let keeps = |column: usize| match self.jacobian.shared[column] {
                Shared::Effect(index, _) => has(&index),
                Shared::Offset(_) | Shared::Constants(_) => true,
            };
            NuisanceProjection::keeping(self.jacobian, self.present, keeps)
        })
    }
}
