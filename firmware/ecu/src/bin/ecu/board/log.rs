//! The log: frames of `defmt` in a ring that a debug probe reads (SEGGER RTT).
//!
//! If the ring has no room for a frame, the whole frame is dropped. Logging never waits for the probe, in any mode that the
//! probe selects, so the ECU does not stop when the cable is removed. The crate `defmt-rtt` is not used, for it can panic.

use core::cell::UnsafeCell;
use core::ptr;
use core::sync::atomic::{AtomicU8, AtomicU32, Ordering};

use defmt::Encoder;

/// Bytes of the ring.
const BYTES: usize = 1_024;
/// Mode of a ring whose writer does not wait. It is only read by the probe.
const NEVER_WAIT: u32 = 1;

static NAME: [u8; 6] = *b"defmt\0";
static RING: [AtomicU8; BYTES] = [const { AtomicU8::new(0) }; BYTES];
static FRAME: Frame = Frame(UnsafeCell::new(Encoder::new()));
/// Next place of the present frame.
static NEXT: AtomicU32 = AtomicU32::new(0);
/// Bytes for which the ring has room left, while a frame is written.
static ROOM: AtomicU32 = AtomicU32::new(0);

/// What the probe looks for in RAM: a ring to the host, none from it.
#[repr(C)]
struct ControlBlock {
    id: [u8; 16],
    rings_up: u32,
    rings_down: u32,
    name: *const u8,
    ring: *const AtomicU8,
    bytes: u32,
    /// Place after the last whole frame.
    written: AtomicU32,
    /// Place that the probe reads next.
    read: AtomicU32,
    mode: AtomicU32,
}

// SAFETY: the pointers are to statics; the program only changes the atomic fields.
unsafe impl Sync for ControlBlock {}

#[used]
#[unsafe(no_mangle)]
static _SEGGER_RTT: ControlBlock = ControlBlock {
    id: *b"SEGGER RTT\0\0\0\0\0\0",
    rings_up: 1,
    rings_down: 0,
    name: ptr::from_ref(&NAME).cast(),
    ring: ptr::from_ref(&RING).cast(),
    bytes: BYTES as u32,
    written: AtomicU32::new(0),
    read: AtomicU32::new(0),
    mode: AtomicU32::new(NEVER_WAIT),
};

struct Frame(UnsafeCell<Encoder>);

// SAFETY: there is one task; no exception handler logs.
unsafe impl Sync for Frame {}

impl Frame {
    fn encode(&self, work: impl FnOnce(&mut Encoder)) {
        // SAFETY: the only reference: `work` is one call of the encoder, which does not log.
        work(unsafe { &mut *self.0.get() });
    }
}

#[defmt::global_logger]
struct Log;

// SAFETY: one task without interrupts logs, so frames do not overlap.
unsafe impl defmt::Logger for Log {
    fn acquire() {
        let written = _SEGGER_RTT.written.load(Ordering::Relaxed);
        let read = _SEGGER_RTT.read.load(Ordering::Relaxed);
        // One byte stays free: a full ring would look empty.
        let room = read.wrapping_sub(written).wrapping_sub(1) % BYTES as u32;
        NEXT.store(written, Ordering::Relaxed);
        ROOM.store(room, Ordering::Relaxed);
        FRAME.encode(|encoder| encoder.start_frame(put));
    }

    unsafe fn flush() {}

    unsafe fn release() {
        FRAME.encode(|encoder| encoder.end_frame(put));
        if ROOM.load(Ordering::Relaxed) > 0 {
            let next = NEXT.load(Ordering::Relaxed);
            _SEGGER_RTT.written.store(next, Ordering::Release);
        }
    }

    unsafe fn write(bytes: &[u8]) {
        FRAME.encode(|encoder| encoder.write(bytes, put));
    }
}

/// Adds bytes to the frame. The last byte of room is not used: that there is none left marks a frame that is too long.
fn put(bytes: &[u8]) {
    for &byte in bytes {
        let (next, room) = (NEXT.load(Ordering::Relaxed), ROOM.load(Ordering::Relaxed));
        if room > 0
            && let Some(place) = RING.get(next as usize)
        {
            place.store(byte, Ordering::Relaxed);
            NEXT.store(next.wrapping_add(1) % BYTES as u32, Ordering::Relaxed);
            ROOM.store(room.saturating_sub(1), Ordering::Relaxed);
        }
    }
}
