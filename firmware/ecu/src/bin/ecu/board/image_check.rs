//! Check of the program in flash, at the start and continuously.
//!
//! The checksum covers the whole image, from the vector table to the initial values of variables; `cargo xtask arm`
//! writes it into the image ([`IMAGE_SEAL`]). An image that was built without that task has no checksum: the reference is
//! then the checksum at the start, which detects later changes only, and the hitch is locked.

use hitch_quantities::crc32::Crc32;

/// Bytes checked in a millisecond: 128 KiB take half a second.
const BYTES: usize = 256;
/// First address of flash.
const START: usize = 0x0800_0000;
/// Words before and after the checksum, which mark its position.
const MAGIC: [u32; 2] = [0x4B43_4548, 0xA5C3_1E7D];
/// Content of erased flash: no checksum.
const UNSEALED: u32 = u32::MAX;

/// Location of the checksum, after [`MAGIC`]. It counts as erased in the computation of the checksum.
#[used]
#[unsafe(no_mangle)]
static IMAGE_SEAL: [u32; 3] = [MAGIC[0], MAGIC[1], UNSEALED];

unsafe extern "C" {
    static __sidata: u32;
    static __sdata: u32;
    static __edata: u32;
}

/// Address of the first byte after the image.
fn end() -> usize {
    let [from, to] = [&raw const __sdata, &raw const __edata].map(|address| address as usize);
    ((&raw const __sidata) as usize).saturating_add(to.saturating_sub(from))
}

/// The checksum's word.
fn place() -> *const u32 {
    (&raw const IMAGE_SEAL)
        .cast::<u32>()
        .wrapping_add(MAGIC.len())
}

/// The check.
pub struct ImageCheck {
    is_sealed: bool,
    expected: u32,
    at: usize,
    checksum: Crc32,
}

impl ImageCheck {
    /// Checks the whole image; `None` if it differs from the one built by the task.
    pub fn start() -> Option<Self> {
        // SAFETY: an aligned word of the image; volatile, because the task changes it after compilation.
        let sealed = unsafe { place().read_volatile() };
        let mut checksum = Crc32::default();
        take(&mut checksum, START, end());
        let found = checksum.value();
        let is_sealed = sealed != UNSEALED;
        (!is_sealed || sealed == found).then(|| Self {
            is_sealed,
            expected: found,
            at: START,
            checksum: Crc32::default(),
        })
    }

    /// Whether the image has a checksum.
    pub const fn is_sealed(&self) -> bool {
        self.is_sealed
    }

    /// Checks the next bytes; false if the image has changed.
    pub fn step(&mut self) -> bool {
        let until = self.at.saturating_add(BYTES).min(end());
        take(&mut self.checksum, self.at, until);
        self.at = until;
        if until < end() {
            return true;
        }
        self.at = START;
        core::mem::take(&mut self.checksum).value() == self.expected
    }
}

/// Continues with the bytes from `from` to `to`; those of the checksum count as erased.
fn take(checksum: &mut Crc32, from: usize, to: usize) {
    let seal = place() as usize..place().wrapping_add(1) as usize;
    take_bytes(checksum, from, to.min(seal.start));
    for _ in seal.start.max(from)..seal.end.min(to) {
        checksum.update(&[0xFF]);
    }
    take_bytes(checksum, from.max(seal.end), to);
}

fn take_bytes(checksum: &mut Crc32, from: usize, to: usize) {
    let Some(length) = to.checked_sub(from) else {
        return;
    };
    // SAFETY: inside the image, which is in flash and read only; any value is acceptable after a change.
    checksum.update(unsafe { core::slice::from_raw_parts(from as *const u8, length) });
}
