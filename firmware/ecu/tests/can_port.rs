//! The bus by a driver of `embedded-can`: nothing is lost in silence, nothing stale is sent, order and priority hold.

use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;

use embedded_can::{Error, ErrorKind, ExtendedId, Frame as _, Id, nb::Can};
use hitch_ecu::CanPort;
use hitch_protocols::can::Frame;

#[derive(Debug, Clone, Copy, PartialEq)]
struct Failure(ErrorKind);

impl Error for Failure {
    fn kind(&self) -> ErrorKind {
        self.0
    }
}

/// What the driver answers next, and the frames that it has accepted.
#[derive(Default)]
struct Script {
    to_receive: VecDeque<nb::Result<Frame, Failure>>,
    to_transmit: VecDeque<nb::Result<Option<Frame>, Failure>>,
    accepted: Vec<Frame>,
}

struct Driver(Rc<RefCell<Script>>);

impl Can for Driver {
    type Frame = Frame;
    type Error = Failure;

    fn transmit(&mut self, frame: &Frame) -> nb::Result<Option<Frame>, Failure> {
        let mut script = self.0.borrow_mut();
        let answer = script.to_transmit.pop_front().unwrap_or(Ok(None));
        if answer.is_ok() {
            script.accepted.push(*frame);
        }
        answer
    }

    fn receive(&mut self) -> nb::Result<Frame, Failure> {
        let mut script = self.0.borrow_mut();
        script
            .to_receive
            .pop_front()
            .unwrap_or(Err(nb::Error::WouldBlock))
    }
}

fn port() -> (Rc<RefCell<Script>>, CanPort<Driver>) {
    let script = Rc::new(RefCell::new(Script::default()));
    (Rc::clone(&script), CanPort::new(Driver(script)))
}

fn id(bits: u32) -> Id {
    Id::Extended(ExtendedId::new(bits).expect("29 bits"))
}

fn frame(bits: u32) -> Frame {
    Frame::new(id(bits), &[1, 2, 3]).expect("three bytes")
}

#[test]
fn data_frames_are_received_and_remote_frames_are_skipped() {
    let (script, mut port) = port();
    let remote = Frame::new_remote(id(7), 3).expect("three bytes");
    script.borrow_mut().to_receive = [Ok(remote), Ok(frame(8))].into();
    assert_eq!(port.receive(), Some(frame(8)));
    assert_eq!(port.receive(), None);
}

#[test]
fn an_overrun_counts_as_a_dropped_frame_and_an_error_of_the_line_does_not() {
    let (script, mut port) = port();
    let errors = [
        ErrorKind::Overrun,
        ErrorKind::Acknowledge,
        ErrorKind::Overrun,
    ];
    script.borrow_mut().to_receive = errors
        .map(|kind| Err(nb::Error::Other(Failure(kind))))
        .into();
    for _ in errors {
        assert_eq!(port.receive(), None);
    }
    assert_eq!(port.dropped(), 2);
}

#[test]
fn a_frame_without_room_is_refused() {
    let (script, mut port) = port();
    script.borrow_mut().to_transmit = [Err(nb::Error::WouldBlock), Ok(None)].into();
    assert!(!port.send(&frame(1)));
    assert!(port.send(&frame(1)));
    assert_eq!(script.borrow().accepted, [frame(1)]);
}

#[test]
fn a_frame_that_gave_way_is_sent_before_the_next_one() {
    let (script, mut port) = port();
    script.borrow_mut().to_transmit = [Ok(Some(frame(9))), Err(nb::Error::WouldBlock)].into();
    assert!(port.send(&frame(1)));
    assert!(!port.send(&frame(2)), "no room for the frame that gave way");
    assert!(port.send(&frame(2)));
    assert_eq!(script.borrow().accepted, [frame(1), frame(9), frame(2)]);
}

#[test]
fn a_frame_that_gave_way_is_not_sent_after_a_fault_of_the_bus() {
    let (script, mut port) = port();
    let off = Err(nb::Error::Other(Failure(ErrorKind::Other)));
    script.borrow_mut().to_transmit = [Ok(Some(frame(9))), off].into();
    assert!(port.send(&frame(1)));
    assert!(port.send(&frame(2)));
    assert_eq!(script.borrow().accepted, [frame(1), frame(2)]);
}
