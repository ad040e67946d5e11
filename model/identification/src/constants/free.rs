//! Constants that are free in a fit.

use std::sync::Arc;

use hitch_plant::Model;
use nalgebra::DMatrix;

use crate::constants::directions::Directions;
use crate::constants::fitted::{CurvePoint, FittedConstant};
use crate::constants::tolerances::{FARTHEST_SIGMAS, Tolerances};

/// Errors of a model's constants, as coordinates along the directions of their prior, in tolerances of data sheets.
#[derive(Debug, Clone)]
pub struct FreeConstants {
    directions: Arc<Directions>,
    declared: Model,
    errors: Vec<f64>,
    share: f64,
    corrected: Model,
    is_held: bool,
}

impl FreeConstants {
    /// The declared constants, free to change within their tolerances.
    #[must_use]
    pub fn of(declared: &Model) -> Self {
        Self::with(declared, &Tolerances::default())
    }

    /// The same with a user's own tolerances.
    #[must_use]
    pub fn with(declared: &Model, own: &Tolerances) -> Self {
        let directions = Arc::new(Directions::new(declared.constants(), own));
        Self {
            errors: vec![0.0; directions.len()],
            share: 1.0,
            corrected: declared.clone(),
            declared: declared.clone(),
            directions,
            is_held: false,
        }
    }

    /// Number of coordinates that a fit moves: none while they are held.
    #[must_use]
    pub fn free(&self) -> usize {
        if self.is_held { 0 } else { self.errors.len() }
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

    /// The model with the corrected constants, and the effects of the declared one.
    #[must_use]
    pub fn corrected(&self) -> &Model {
        &self.corrected
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
            && let Some(corrected) = self.directions.corrected(&self.declared, &errors)
        {
            (self.errors, self.corrected) = (errors, corrected);
        }
    }

    /// Constants and points of the flow curves with their intervals, from the covariance of the coordinates, in prior
    /// sigmas.
    pub(crate) fn fitted(
        &self,
        covariance: &DMatrix<f64>,
    ) -> (Vec<FittedConstant>, Vec<CurvePoint>) {
        let models = [&self.declared, &self.corrected];
        let covariance = covariance * self.share.powi(2);
        let directions = &self.directions;
        directions.fitted(models, &self.errors, self.share, &covariance)
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
