//! Test of the whole RAM at power-up, before its initialisation.
//!
//! A march test over all words, upwards and downwards: each word is compared with its last value, and filled with a
//! pattern, its complement and its own address. The test detects stuck bits, and words with a shared address line. It
//! takes 60 ms at the initial clock of 16 MHz.

use core::arch::naked_asm;

/// Called by the start-up code before it initialises RAM. There is no stack yet, so only registers are used. With
/// damaged RAM it never returns: all outputs of the part stay off.
#[unsafe(no_mangle)]
#[unsafe(naked)]
unsafe extern "C" fn __pre_init() {
    naked_asm!(
        // r0: first address, r1: end, r2: pattern, r3: complement
        "movw r0, #0",
        "movt r0, #0x2000",
        "add  r1, r0, #0x20000",
        "mov  r2, #0x55555555",
        "mvn  r3, r2",
        "mov  r4, r0",
        // Up: write the pattern.
        "1:",
        "str  r2, [r4], #4",
        "cmp  r4, r1",
        "bne  1b",
        "mov  r4, r0",
        // Up: read the pattern, write its complement.
        "2:",
        "ldr  r5, [r4]",
        "cmp  r5, r2",
        "bne  5f",
        "str  r3, [r4], #4",
        "cmp  r4, r1",
        "bne  2b",
        // Down: read the complement, write the address.
        "3:",
        "ldr  r5, [r4, #-4]!",
        "cmp  r5, r3",
        "bne  5f",
        "str  r4, [r4]",
        "cmp  r4, r0",
        "bne  3b",
        // Up: read the address.
        "4:",
        "ldr  r5, [r4]",
        "cmp  r5, r4",
        "bne  5f",
        "add  r4, r4, #4",
        "cmp  r4, r1",
        "bne  4b",
        "bx   lr",
        "5:",
        "b    5b",
    )
}
