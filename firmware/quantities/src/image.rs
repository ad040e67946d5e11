//! Fixed images of numbers: one after the other.

/// Writes numbers one after the other; what doesn't fit is dropped.
#[derive(Debug)]
pub struct Writer<const N: usize> {
    bytes: [u8; N],
    at: usize,
}

impl<const N: usize> Default for Writer<N> {
    fn default() -> Self {
        Self {
            bytes: [0; N],
            at: 0,
        }
    }
}

impl<const N: usize> Writer<N> {
    /// Writes the bytes of a number.
    pub fn put<const M: usize>(&mut self, number: [u8; M]) {
        let rest = self.bytes.get_mut(self.at..);
        if let Some(target) = rest.and_then(|rest| rest.first_chunk_mut()) {
            *target = number;
        }
        self.at = self.at.saturating_add(M);
    }

    /// The image; zeros where nothing was written.
    #[must_use]
    pub const fn bytes(self) -> [u8; N] {
        self.bytes
    }
}

/// Reads numbers one after the other.
#[derive(Debug)]
pub struct Reader<'a>(pub &'a [u8]);

impl Reader<'_> {
    /// The bytes of the next number; zeros beyond the end.
    pub fn take<const M: usize>(&mut self) -> [u8; M] {
        let (number, rest) = self.0.split_first_chunk().unwrap_or((&[0; M], &[]));
        self.0 = rest;
        *number
    }
}
