//! The flashed images contain nothing that panics.

use std::path::PathBuf;

fn panics(image: &str) -> Vec<String> {
    let folder = std::env::var_os("HITCH_BOARD_IMAGES").expect("the folder with the images");
    let bound = image_stack::of(&PathBuf::from(folder).join(image)).unwrap();
    bound.panics
}

#[test]
#[ignore = "needs the ARM images: run by `cargo xtask test`"]
fn the_images_for_the_boards_cannot_panic() {
    for image in ["ecu-stm32f405", "ecu-stm32g474", "ecu-nucleo-g474re"] {
        assert_eq!(panics(image), Vec::<String>::new(), "{image}");
    }
}

/// It talks to its host with plain arithmetic.
#[test]
#[ignore = "needs the ARM images: run by `cargo xtask test`"]
fn panics_of_the_emulated_image_are_found_with_their_callers() {
    let panics = panics("emulated");
    assert!(
        panics
            .iter()
            .any(|panic| panic.starts_with("core::panicking::") && panic.contains("emulated::")),
        "{panics:#?}"
    );
}
