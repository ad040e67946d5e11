//! The folders of a crate are layers: a folder may use only itself and lower ones.
//!
//! Cargo prevents cyclic dependencies of crates, but not of the folders in a crate. This check therefore reads the
//! paths in the sources: each has to lead to the same folder or to a lower one.
//! Tests are exempt.

use std::collections::BTreeSet;

use anyhow::{Context, Result, ensure};

use crate::sources::{Crate, Names, Source};

/// The folders of a crate in their order.
struct Layers {
    /// Folder of the crate's sources, relative to the workspace's root.
    sources: &'static str,
    /// Its top modules, the lowest first; modules of one entry may use each other.
    order: &'static [&'static [&'static str]],
}

/// The checked crates; add an entry for a new one.
const CRATES: [Layers; 15] = [
    Layers {
        sources: "firmware/quantities/src",
        order: &[
            &["codes", "crc32", "fixed", "fnv", "image", "units"],
            &["piston"],
            &["calibration"],
            &["signals"],
        ],
    },
    Layers {
        sources: "firmware/control/src",
        order: &[
            &["valve"],
            &["sensing"],
            &["operator"],
            &["reference"],
            &["ride"],
            &["estimation"],
            &["adaptation"],
            &["motion"],
            &["sequencing"],
            &["current"],
            &["commissioning"],
            &["controller"],
        ],
    },
    Layers {
        sources: "firmware/protocols/src",
        order: &[&["can"], &["j1939"], &["key"], &["storage"], &["xcp"]],
    },
    Layers {
        sources: "model/plant/src",
        order: &[
            &["channel", "units"],
            &["components"],
            &["constants"],
            &["state", "valve"],
            &["hooks"],
            &["model"],
            &["solver"],
            &["plant"],
            &["simulation"],
        ],
    },
    Layers {
        sources: "model/effects/src",
        order: &[
            &["expression", "order"],
            &["described", "catalogue"],
            &["term_effect"],
        ],
    },
    Layers {
        sources: "model/field/src",
        order: &[
            &["noise"],
            &["draft", "strength"],
            &["soil", "implement", "terrain", "tyre", "body", "sensors"],
            &["tractor"],
        ],
    },
    Layers {
        sources: "model/draft/src",
        order: &[
            &["machine", "block"],
            &["log"],
            &["manifest"],
            &["term"],
            &["whitening"],
            &["evidence"],
            &["next_run"],
            &["fit"],
            &["simulated"],
        ],
    },
    Layers {
        sources: "model/measurement/src",
        order: &[
            &["statistics"],
            &["finding"],
            &["logs"],
            &["lifting"],
            &["rest_pressure"],
            &[
                "dead_pressure",
                "load",
                "pressure_unit",
                "pump_below_cylinder",
            ],
            &[
                "current_zero",
                "delay",
                "direction",
                "equal_samples",
                "logger",
                "no_motion",
                "repeated_run",
                "spikes",
            ],
        ],
    },
    Layers {
        sources: "model/identification/src",
        order: &[
            &["parallel"],
            &["data", "constants"],
            &["estimate"],
            &["residuals"],
            &["estimation"],
            &["adequacy"],
            &["selection"],
            &["search"],
            &["design"],
            &["explanation"],
            &["suggestion"],
            &["base"],
        ],
    },
    Layers {
        sources: "workbench/closed-loop/src",
        order: &[
            &["valve_survey"],
            &["closed_loop"],
            &["calibrate", "field"],
            &["driven"],
        ],
    },
    Layers {
        sources: "workbench/fmu/src",
        order: &[
            &["kind", "location", "units", "variable"],
            &["component"],
            &["plant", "controller"],
            &["description"],
            &["content"],
            &["abi"],
        ],
    },
    Layers {
        sources: "workbench/try-page/src",
        order: &[&["bench"], &["abi"]],
    },
    Layers {
        sources: "workbench/ecu-host/src",
        order: &[&["xcp_tool"], &["ecu"]],
    },
    Layers {
        sources: "workbench/results/src",
        order: &[
            &["arguments", "measurement", "web"],
            &["base_model"],
            &[
                "closed_loop",
                "comparison",
                "draft",
                "explanation",
                "fleet_summary",
                "fmu_export",
                "import",
            ],
            &["field_loop"],
            &["tuning"],
            &["report"],
        ],
    },
    Layers {
        sources: "workbench/src",
        order: &[&["commands"], &["cli"], &["main"]],
    },
];

/// Rejects imports of higher layers, and modules without an entry.
pub fn check(crates: &[Crate]) -> Result<()> {
    let mut wrong = Vec::new();
    for layers in &CRATES {
        let folder = layers.sources;
        let sources = crates.iter().find(|one| one.folder == folder);
        let sources = sources.with_context(|| format!("there are no sources in {folder}"))?;
        for (module, source) in &sources.files {
            let faults = layers.judge(module, source).into_iter();
            wrong.extend(faults.map(|what| format!("{folder}, {}: {what}", module.join("::"))));
        }
    }
    ensure!(
        wrong.is_empty(),
        "folders of a crate use those above them:\n{}",
        wrong.join("\n")
    );
    println!("no folder of a crate uses one above it");
    Ok(())
}

impl Layers {
    /// Level of a module.
    fn height(&self, module: &str) -> Option<usize> {
        self.order.iter().position(|layer| layer.contains(&module))
    }

    /// Faults of the file of a module.
    fn judge(&self, module: &Names, source: &Source) -> Vec<String> {
        // The root of the crate declares all of them.
        let Some(own) = module.first() else {
            return Vec::new();
        };
        let Some(height) = self.height(own) else {
            return vec![format!(
                "`{own}` has no place in the order of xtask/src/layers.rs"
            )];
        };
        let wrong = source.paths().filter_map(|path| {
            let used = top(module, path)?;
            let path = path.join("::");
            match self.height(&used) {
                Some(other) if other <= height => None,
                Some(_) => Some(format!("`{own}` uses `{used}`, which is above it: {path}")),
                None => Some(format!("{path}: name the module of `{used}`")),
            }
        });
        wrong.collect::<BTreeSet<_>>().into_iter().collect()
    }
}

/// The top module of a path, as seen from a module; `None` for another crate, or for the root.
fn top(module: &[String], path: &[String]) -> Option<String> {
    let ups = path.iter().take_while(|name| *name == "super").count();
    let inside = match path.first()?.as_str() {
        "crate" => &path[1..],
        "super" if module.len() > ups => return module.first().cloned(),
        "super" => &path[ups..],
        _ => return None,
    };
    inside.first().cloned()
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::Path;

    use arm_build::workspace;

    use super::*;
    use crate::sources::{crates, module_of};

    const LAYERS: Layers = Layers {
        sources: "",
        order: &[&["low", "beside"], &["middle"], &["high"]],
    };

    fn wrong(place: &str, text: &str) -> usize {
        let source = Source::parsed(text).unwrap();
        LAYERS.judge(&module_of(Path::new(place)), &source).len()
    }

    #[test]
    fn a_folder_may_use_itself_what_is_beside_it_and_what_is_below_it() {
        assert_eq!(
            wrong("middle/a.rs", "use super::b::B;\nuse crate::low::C;"),
            0
        );
        assert_eq!(
            wrong("low.rs", "use crate::beside::B;\nuse super::beside::C;"),
            0
        );
        assert_eq!(wrong("middle/mod.rs", "use crate::{low::A, middle::b};"), 0);
        assert_eq!(
            wrong("middle/a.rs", "use core::high::X;\nuse other::high::Y;"),
            0
        );
    }

    #[test]
    fn what_is_above_it_is_refused_however_it_is_written() {
        for text in [
            "use crate::high::X;",
            "use crate::{low::A, high::{B, C}};",
            "use super::super::high::X;",
            "pub(crate) use crate::{\n    low,\n    high,\n};",
            "fn f() -> crate::high::X { todo!() }",
        ] {
            assert_ne!(wrong("middle/a.rs", text), 0, "{text}");
        }
        assert_eq!(wrong("middle/mod.rs", "use super::high::X;"), 1);
        assert_eq!(wrong("middle.rs", "use super::high::X;"), 1);
    }

    #[test]
    fn comments_tests_and_the_front_page_may_name_everything() {
        assert_eq!(
            wrong(
                "middle/a.rs",
                "//! See [`crate::high`].\n/// [`super::super::high`]\nfn f() {}"
            ),
            0
        );
        let tests = "use crate::low::A;\n#[cfg(test)]\nmod tests {\n    use crate::high::X;\n}\n";
        assert_eq!(wrong("middle/a.rs", tests), 0);
        assert_eq!(wrong("lib.rs", "pub use crate::high::X;"), 0);
    }

    #[test]
    fn a_module_without_a_place_is_refused() {
        assert_eq!(wrong("new/a.rs", ""), 1);
    }

    #[test]
    fn the_crates_keep_their_order() {
        check(&crates().unwrap()).unwrap();
    }

    #[test]
    fn arithmetic_that_overflows_is_caught_in_every_crate_of_the_firmware() {
        let firmware = workspace::root().join("firmware");
        let manifest = fs::read_to_string(workspace::root().join("Cargo.toml")).unwrap();
        let mut crates = 0;
        for entry in fs::read_dir(firmware).unwrap() {
            let Ok(text) = fs::read_to_string(entry.unwrap().path().join("Cargo.toml")) else {
                continue;
            };
            let name = text.split('"').nth(1).unwrap();
            let checked = format!("[profile.firmware.package.{name}]\noverflow-checks = true\n");
            assert!(manifest.contains(&checked), "{name}");
            crates += 1;
        }
        assert_eq!(crates, 6);
    }
}
