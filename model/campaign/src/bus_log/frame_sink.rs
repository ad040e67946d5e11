//! Receiver of the frames of a log.

use crate::CampaignError;
use crate::bus_log::frame::{Frame, Id};

/// A receiver of frames.
pub trait FrameSink {
    /// Whether data frames with this identifier on this channel are wanted; others need not be readable.
    fn wants(&mut self, channel: &str, id: Id) -> bool;

    /// Takes a frame that is wanted.
    ///
    /// # Errors
    /// If it can't be what it should be.
    fn take(&mut self, frame: &Frame<'_>) -> Result<(), CampaignError>;
}
