//! Linker arguments of the images; the host build needs none.

use std::env;

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-changed=../../memory.x");
    if env::var("CARGO_CFG_TARGET_OS").as_deref() != Ok("none") {
        return;
    }
    // The linker runs in the workspace's root, so that `link.x` finds `memory.x` there.
    println!("cargo:rustc-link-arg-bins=-Tlink.x");
    println!("cargo:rustc-link-arg-bins=--nmagic");
    // `cargo xtask arm` reads from them which functions have their address taken, and so can be called by it.
    println!("cargo:rustc-link-arg-bins=--emit-relocs");
    println!("cargo:rustc-link-arg-bin=ecu=-Tdefmt.x");
    if env::var_os("CARGO_FEATURE_STM32G474").is_some() {
        println!("cargo:rustc-link-arg-bin=ecu=--defsym=_stm32g474=1");
    }
    if env::var_os("CARGO_FEATURE_EMULATED").is_some() {
        println!("cargo:rustc-link-arg-bin=emulated=--defsym=_mps2_an386=1");
    }
}
