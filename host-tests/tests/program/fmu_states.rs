//! Units of `hitch export-fmu` go back to stored states.

use std::fs;

use host_tests::python::scripts;

use crate::fmu::{export, python, script, units, with_every_effect};

#[test]
fn a_restored_unit_repeats_its_steps() {
    let Some(python) = python() else { return };
    let states = scripts().join("fmu_states.py");
    let every = hitch_model_file::to_toml(&with_every_effect("every effect"));
    let folder = units();
    fs::write(folder.path().join("every.toml"), &every).unwrap();
    for (model, unit) in [("every.toml", "every.fmu"), ("nominal", "nominal.fmu")] {
        export(folder.path(), &[model, "--out", unit]);
    }
    for arguments in [
        &["plant", "plant.fmu", "start_angle_deg=90"][..],
        &["plant", "nominal.fmu", "start_angle_deg=90", "load_kg=50"],
        &[
            "plant",
            "every.fmu",
            "start_angle_deg=90",
            "oil_temperature_c=62",
        ],
        &["controller", "controller.fmu"],
    ] {
        let said = script(python, folder.path(), &states, arguments);
        println!("{arguments:?}: {said}");
        assert!(said.contains("repeated: 500 steps"), "{said}");
    }
}
