//! Commands that select and copy pages of the calibration: one segment with a working and a reference page.

use hitch_quantities::calibration::CALIBRATION_BYTES;

use super::error::Refusal;
use super::map::{CALIBRATION_BASE, EcuMemory};
use super::memory::Page;
use super::packet::{Answer, arguments, done, response};

const SEGMENTS: u8 = 1;
const PAGES: u8 = 2;
/// Target of a page selection.
const CONTROLLER: u8 = 0x01;
const TOOL: u8 = 0x02;
/// For all segments; the segment number is ignored.
const ALL: u8 = 0x80;

/// SET_CAL_PAGE: mode, segment, page.
pub(super) fn set_page(rest: &[u8], memory: &mut EcuMemory<'_>) -> Answer {
    let [mode, segment, number] = arguments(rest)?;
    if mode & ALL == 0 {
        check_segment(segment)?;
    }
    let page = Page::from_number(number).ok_or(Refusal::PageNotValid)?;
    if mode & (CONTROLLER | TOOL) == 0 {
        return Err(Refusal::ModeNotValid);
    }
    // The selection that can be refused comes first, so that a refusal changes nothing.
    if mode & CONTROLLER != 0 {
        memory.set_controller_page(page)?;
    }
    if mode & TOOL != 0 {
        memory.pages.set_tool_page(page);
    }
    done()
}

/// GET_CAL_PAGE: target, segment.
pub(super) fn page(rest: &[u8], memory: &EcuMemory<'_>) -> Answer {
    let [access, segment] = arguments(rest)?;
    check_segment(segment)?;
    let page = match access {
        CONTROLLER => memory.pages.controller_page(),
        TOOL => memory.pages.tool_page(),
        _ => return Err(Refusal::ModeNotValid),
    };
    response(&[0, 0, page as u8])
}

/// GET_PAG_PROCESSOR_INFO: one segment, no freezing.
pub(super) fn info() -> Answer {
    response(&[SEGMENTS, 0])
}

/// GET_SEGMENT_INFO: address of the segment, and number of pages.
pub(super) fn segment_info(rest: &[u8]) -> Answer {
    let [mode, segment, info] = arguments(rest)?;
    check_segment(segment)?;
    let basic = match (mode, info) {
        (0, 0) => CALIBRATION_BASE,
        (0, 1) => CALIBRATION_BYTES as u32,
        // Nothing is extended, mapped, compressed or encrypted.
        (1, _) => return response(&[PAGES, 0, 0, 0, 0]),
        _ => return Err(Refusal::OutOfRange),
    };
    let [a, b, c, d] = basic.to_le_bytes();
    response(&[0, 0, 0, a, b, c, d])
}

/// GET_PAGE_INFO: controller and tool can access both pages independently; only the working page is writable, by the
/// tool.
pub(super) fn page_info(rest: &[u8]) -> Answer {
    /// Access with or without the other: bits 0 and 1 for the controller, 2 and 3 for reading by the tool.
    const READABLE: u8 = 0x0F;
    /// By the tool, independent of the controller.
    const WRITABLE: u8 = 0x30;
    let [_, segment, page] = arguments(rest)?;
    check_segment(segment)?;
    match Page::from_number(page).ok_or(Refusal::PageNotValid)? {
        Page::Working => response(&[READABLE | WRITABLE, 0]),
        Page::Reference => response(&[READABLE, 0]),
    }
}

/// COPY_CAL_PAGE: only from the reference page to the working page.
pub(super) fn copy(rest: &[u8], memory: &mut EcuMemory<'_>) -> Answer {
    let [from_segment, from, to_segment, to] = arguments(rest)?;
    check_segment(from_segment)?;
    check_segment(to_segment)?;
    if from >= PAGES || to >= PAGES {
        return Err(Refusal::PageNotValid);
    }
    match (Page::from_number(from), Page::from_number(to)) {
        (Some(Page::Reference), Some(Page::Working)) => memory.restore_working_page()?,
        (_, Some(Page::Reference)) => return Err(Refusal::WriteProtected),
        _ => return Err(Refusal::ModeNotValid),
    }
    done()
}

const fn check_segment(number: u8) -> Result<(), Refusal> {
    if number < SEGMENTS {
        Ok(())
    } else {
        Err(Refusal::SegmentNotValid)
    }
}
