//! Receiver of the frames of a log.

use crate::CampaignError;
use crate::bus_log::frame::{Frame, Id};

/// A receiver of frames.
pub trait FrameSink {
    /// Whether data frames with this identifier on this channel are wanted; others are not parsed.
    fn wants(&mut self, channel: &str, id: Id) -> bool;

    /// Receives a wanted frame.
    ///
    /// # Errors
    /// The frame is not valid.
    fn take(&mut self, frame: &Frame<'_>) -> Result<(), CampaignError>;
}
