//! Measured less simulated, whitened by the noise of instruments and model.

pub mod contact_mask;
pub mod whitening;
