//! What the emulator was told to tell the image.

use cortex_m_semihosting::{nr, syscall1};

/// True if the command line is `word`.
pub fn is(word: &[u8]) -> bool {
    let mut line = [0_u8; 64];
    let mut block = [line.as_mut_ptr() as usize, line.len()];
    // SAFETY: the call fills the buffer with a C string no longer than it was told, and writes its length into the
    // block; both are alive during the call.
    let failed = unsafe { syscall1(nr::GET_CMDLINE, block.as_mut_ptr() as usize) } != 0;
    let length = line.iter().position(|&byte| byte == 0).unwrap_or(0);
    !failed && &line[..length] == word
}
