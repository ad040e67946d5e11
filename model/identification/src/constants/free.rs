//! Constants that are free in a fit.

use std::sync::Arc;

use hitch_plant::Model;
use nalgebra::DMatrix;

use crate::constants::directions::Directions;
use crate::constants::fitted::{CurvePoint, FittedConstant};

/// Bound of a coordinate, in prior sigmas: a larger error is outside the tolerances of data sheets.
pub const FARTHEST_SIGMAS: f64 = 3.0;

/// Errors of a model's constants, as coordinates along the directions of their prior.
#[derive(Debug, Clone)]
pub struct FreeConstants {
    directions: Arc<Directions>,
    declared: Model,
    sigmas: Vec<f64>,
    corrected: Model,
    is_held: bool,
}

impl FreeConstants {
    /// The declared constants, free to change.
    #[must_use]
    pub fn of(declared: &Model) -> Self {
        let directions = Arc::new(Directions::new(declared.constants()));
        Self {
            sigmas: vec![0.0; directions.len()],
            corrected: declared.clone(),
            declared: declared.clone(),
            directions,
            is_held: false,
        }
    }

    /// Number of coordinates that a fit moves: none while they are held.
    #[must_use]
    pub fn free(&self) -> usize {
        match self.is_held {
            true => 0,
            false => self.sigmas.len(),
        }
    }

    /// The same constants, held in a fit.
    #[must_use]
    pub fn held(self) -> Self {
        Self {
            is_held: true,
            ..self
        }
    }

    /// The coordinates, in prior sigmas.
    #[must_use]
    pub fn sigmas(&self) -> &[f64] {
        &self.sigmas
    }

    /// The model with the corrected constants, and the effects of the declared one.
    #[must_use]
    pub fn corrected(&self) -> &Model {
        &self.corrected
    }

    /// Moves a coordinate, within its bound. Dimensions that make no linkage leave it where it is.
    pub fn set(&mut self, coordinate: usize, sigmas: f64) {
        let mut moved = self.sigmas.clone();
        moved[coordinate] = sigmas;
        self.set_all(moved);
    }

    /// Moves all coordinates, within their bounds.
    pub fn set_all(&mut self, mut sigmas: Vec<f64>) {
        for value in &mut sigmas {
            *value = value.clamp(-FARTHEST_SIGMAS, FARTHEST_SIGMAS);
        }
        if sigmas != self.sigmas
            && let Some(corrected) = self.directions.corrected(&self.declared, &sigmas)
        {
            (self.sigmas, self.corrected) = (sigmas, corrected);
        }
    }

    /// Constants and points of the flow curves with their intervals, from the covariance of the coordinates.
    pub(crate) fn fitted(
        &self,
        covariance: &DMatrix<f64>,
    ) -> (Vec<FittedConstant>, Vec<CurvePoint>) {
        let models = [&self.declared, &self.corrected];
        self.directions.fitted(models, &self.sigmas, covariance)
    }

    /// Whether a coordinate is at its bound: the constants then do not explain the data within their tolerances.
    #[must_use]
    pub fn is_at_an_end(&self) -> bool {
        let mut sigmas = self.sigmas.iter();
        sigmas.any(|sigmas| sigmas.abs() >= 0.999 * FARTHEST_SIGMAS)
    }

    /// Squared distance from the declared constants, in prior sigmas.
    #[must_use]
    pub fn prior_cost(&self) -> f64 {
        self.sigmas.iter().map(|sigmas| sigmas * sigmas).sum()
    }
}
