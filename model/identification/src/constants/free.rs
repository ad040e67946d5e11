//! Constants that are free in a fit.

use std::sync::Arc;

use hitch_plant::{AddedEffect, Model};
use nalgebra::{DMatrix, DVector};

use crate::constants::correction::{corrected, with_sensor_errors};
use crate::constants::directions::{Directions, SMOOTH};
use crate::constants::fitted::{CurvePoint, Fitted, FittedConstant, Posterior};
use crate::constants::parameter::Parameter;
use crate::constants::tolerances::{FARTHEST_SIGMAS, Tolerances};
use crate::parallel;

/// Errors of a model's constants, as coordinates along the directions of their prior, in tolerances of data sheets.
#[derive(Debug, Clone)]
pub struct FreeConstants {
    directions: Arc<Directions>,
    declared: Model,
    errors: Vec<f64>,
    share: f64,
    /// Errors of the unknowns, and the model with them.
    of_unknowns: DVector<f64>,
    corrected: Model,
    is_held: bool,
}

impl FreeConstants {
    /// The declared constants, free to change within their tolerances.
    #[must_use]
    pub fn of(declared: &Model) -> Self {
        Self::with(declared, &Tolerances::default())
    }

    /// The same with a user's own tolerances. Flow curves keep the reading errors of their points.
    #[must_use]
    pub fn with(declared: &Model, own: &Tolerances) -> Self {
        let unknowns = own.unknowns(declared.constants());
        Self::along(
            declared,
            Directions::new(declared.constants(), unknowns, own, SMOOTH),
        )
    }

    /// Some unknowns, free to change; of flow curves each point.
    #[must_use]
    pub fn among(declared: &Model, unknowns: Vec<Parameter>, own: &Tolerances) -> Self {
        Self::along(
            declared,
            Directions::new(declared.constants(), unknowns, own, 0.0),
        )
    }

    fn along(declared: &Model, directions: Directions) -> Self {
        Self {
            errors: vec![0.0; directions.len()],
            share: 1.0,
            of_unknowns: DVector::zeros(directions.parameters().len()),
            corrected: declared.clone(),
            declared: declared.clone(),
            directions: Arc::new(directions),
            is_held: false,
        }
    }

    /// Number of coordinates that a fit moves: none while they are held.
    #[must_use]
    pub fn free(&self) -> usize {
        if self.is_held { 0 } else { self.errors.len() }
    }

    /// Whether the coordinates are fewer than the unknowns: flow curves keep the reading errors of their points.
    #[must_use]
    pub fn is_smooth(&self) -> bool {
        self.errors.len() < self.of_unknowns.len()
    }

    /// The same constants, held in a fit or not.
    #[must_use]
    pub fn held(self, is_held: bool) -> Self {
        Self { is_held, ..self }
    }

    /// The same constants with another prior: one sigma is this share of their tolerances.
    #[must_use]
    pub fn within(self, share: f64) -> Self {
        let errors = self.errors.clone();
        let mut narrowed = Self { share, ..self };
        narrowed.set_all(errors);
        narrowed
    }

    /// One sigma of the prior of every coordinate, in tolerances.
    #[must_use]
    pub fn share(&self) -> f64 {
        self.share
    }

    /// The coordinates, in tolerances.
    #[must_use]
    pub fn errors(&self) -> &[f64] {
        &self.errors
    }

    /// The model with the corrected constants, and given effects with the errors of the sensors.
    #[must_use]
    pub fn corrected(&self, effects: Vec<AddedEffect>) -> Model {
        let unknowns = self.directions.parameters();
        let effects = with_sensor_errors(effects, unknowns, &self.of_unknowns);
        self.corrected.with_effects(effects)
    }

    /// The same coordinates, but the model with these errors of the unknowns; `None` if the dimensions make no linkage.
    fn at(&self, of_unknowns: DVector<f64>) -> Option<Self> {
        let unknowns = self.directions.parameters();
        let corrected = corrected(&self.declared, unknowns, &of_unknowns)?;
        Some(Self {
            of_unknowns,
            corrected,
            ..self.clone()
        })
    }

    /// Sensitivities along the coordinates, in prior sigmas. `quotient` returns the difference quotient between two models with
    /// a step of this many tolerances between them. Each unknown is moved by itself: the errors of quotients along directions
    /// add up to a slope along unknowns that the campaign does not show.
    pub(crate) fn sensitivities(
        &self,
        step: f64,
        quotient: impl Fn([&Self; 2], f64) -> Vec<Vec<f64>> + Sync,
    ) -> Vec<Vec<Vec<f64>>> {
        let of_unknown = |unknown: usize| {
            let side = |step: f64| {
                let mut moved = self.of_unknowns.clone();
                moved[unknown] += step * self.directions.prior().sigma[unknown];
                self.at(moved)
            };
            Some(quotient([&side(-step)?, &side(step)?], 2.0 * step))
        };
        let of_unknowns = parallel::map(0..self.of_unknowns.len(), of_unknown);
        self.directions.combined(&of_unknowns, self.share)
    }

    /// Moves a coordinate, within its bound. Dimensions that make no linkage leave it where it is.
    pub fn set(&mut self, coordinate: usize, error: f64) {
        let mut moved = self.errors.clone();
        moved[coordinate] = error;
        self.set_all(moved);
    }

    /// Moves all coordinates, within their bounds.
    pub fn set_all(&mut self, mut errors: Vec<f64>) {
        let farthest = self.farthest();
        for value in &mut errors {
            *value = value.clamp(-farthest, farthest);
        }
        if errors != self.errors
            && let Some(moved) = self.at(self.directions.errors(&errors))
        {
            *self = Self { errors, ..moved };
        }
    }

    /// The errors of the unknowns.
    pub(crate) fn errors_of_unknowns(&self) -> &DVector<f64> {
        &self.of_unknowns
    }

    /// Posterior of each unknown, from the covariance of the coordinates, in prior sigmas.
    pub(crate) fn posterior(&self, covariance: &DMatrix<f64>) -> Vec<Posterior> {
        let covariance = covariance * self.share.powi(2);
        self.directions.posterior(self.share, &covariance)
    }

    /// What is known of each unknown without a campaign.
    pub(crate) fn prior(&self) -> Vec<Posterior> {
        let sigma = self.directions.prior().sigma.iter();
        let determined = false;
        sigma
            .map(|&sigma| Posterior { sigma, determined })
            .collect()
    }

    /// Constants and points of the flow curves of a model whose unknowns have these errors, with intervals from their
    /// posterior.
    pub(crate) fn fitted(
        &self,
        model: &Model,
        errors: &DVector<f64>,
        posterior: &[Posterior],
    ) -> (Vec<FittedConstant>, Vec<CurvePoint>) {
        let fitted = Fitted {
            declared: &self.declared,
            model,
            parameters: self.directions.parameters(),
            theta: errors,
            posterior,
            prior: self.directions.prior(),
        };
        (fitted.constants(), fitted.curves())
    }

    /// Largest error along a coordinate, in tolerances.
    #[must_use]
    pub fn farthest(&self) -> f64 {
        FARTHEST_SIGMAS * self.share
    }

    /// Whether a coordinate is at the end of its tolerance: the constants then do not explain the data.
    #[must_use]
    pub fn is_at_an_end(&self) -> bool {
        let mut errors = self.errors.iter();
        errors.any(|error| error.abs() >= 0.999 * FARTHEST_SIGMAS)
    }

    /// Squared distance from the declared constants, in prior sigmas.
    #[must_use]
    pub fn prior_cost(&self) -> f64 {
        let errors = self.errors.iter();
        errors.map(|error| (error / self.share).powi(2)).sum()
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::DVector;

    use super::FreeConstants;
    use crate::constants::tolerances::Tolerances;

    /// A campaign that shows nothing but the bore has slopes in the proportion in which the coordinates move the bore, however
    /// inexact its quotients are.
    #[test]
    fn unknowns_without_influence_have_no_slope() {
        let model = hitch_model_file::nominal();
        let own = Tolerances::default();
        let unknowns = own.unknowns(model.constants());
        let free = FreeConstants::among(&model, unknowns, &own);
        let bore_m = |free: &FreeConstants| free.corrected(Vec::new()).constants().cylinder.bore_m;
        let inexact = |free: &FreeConstants| (1e5 * bore_m(free)).round();
        let columns = free.sensitivities(0.02, |[down, up], step| {
            vec![vec![(inexact(up) - inexact(down)) / step]]
        });
        let of_bore = |coordinate: usize| {
            let mut moved = free.clone();
            moved.set(coordinate, 0.5);
            (bore_m(&moved) / bore_m(&free)).ln()
        };
        let slopes = DVector::from_iterator(columns.len(), columns.iter().map(|c| c[0][0]));
        let moves = DVector::from_iterator(columns.len(), (0..columns.len()).map(of_bore));
        let angle = slopes.normalize() - moves.normalize();
        println!("{} coordinates, {:e}", columns.len(), angle.norm());
        assert!(slopes.norm() > 0.0 && angle.norm() < 1e-6);
    }
}
