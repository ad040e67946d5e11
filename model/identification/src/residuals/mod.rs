//! Measured less simulated, whitened by the noise of instruments and model.

pub(crate) mod contact_mask;
mod phase;
mod walk;
pub mod whitening;
