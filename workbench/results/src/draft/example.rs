//! A draft campaign drawn from the model of the field, as files.

use std::fmt::Write as _;
use std::path::Path;

use hitch_draft::machine::{KINDS, Machine};
use hitch_draft::simulated::{Pass, Truth, runs};
use hitch_field::draft::Texture;

use hitch_output::error::Error;

/// Two depths by three speeds, twice, and one run above the soil.
fn passes() -> Vec<Pass> {
    let pass = |depth_m, speed_km_h, length_m| Pass {
        depth_m,
        speed_km_h,
        length_m,
    };
    let mut passes = vec![pass(-0.2, 6.0, 40.0)];
    for depth_m in [0.16, 0.26] {
        for speed_km_h in [4.5, 6.5, 8.5] {
            passes.extend([pass(depth_m, speed_km_h, 60.0); 2]);
        }
    }
    passes
}

/// Writes a campaign with a plough of three furrows in loam into a new folder. Its shares are blunt, and its draft is 15 %
/// above the standard's.
///
/// # Errors
/// If the folder has files, or cannot be written.
pub fn write_example(folder: &Path, seed: u64) -> Result<(), Error> {
    hitch_output::check_new_folder("FOLDER", folder)?;
    hitch_output::create_folder(folder)?;
    let machine = Machine {
        kind: KINDS[1],
        width: 1.2,
        texture: Texture::Medium,
    };
    let mut truth = Truth::standard(machine);
    truth.coefficients = truth.coefficients.map(|coefficient| 1.15 * coefficient);
    truth.blunt_n = 3500.0;
    let mut manifest = "format = 1\nname = \"Three furrows in loam\"\n\n[implement]\nkind = \"mouldboard-plough\"\nwidth_m = 1.2\n\n\
                        [soil]\ntexture = \"medium\"\n"
        .to_owned();
    for run in runs(&truth, &passes(), seed) {
        let file = format!("{}.csv", run.name);
        let mut text = "time_s,speed_km_h,depth_cm,draft_kn\n".to_owned();
        for sample in &run.samples {
            // Writing to a string cannot fail.
            let _ = writeln!(
                text,
                "{:.2},{:.3},{:.2},{:.3}",
                sample.time_s,
                3.6 * sample.speed_m_s,
                100.0 * sample.depth_m,
                1e-3 * sample.draft_n
            );
        }
        hitch_output::write_file(&folder.join(&file), text.as_bytes())?;
        let _ = write!(manifest, "\n[[run]]\nfile = \"{file}\"\n");
    }
    hitch_output::write_file(&folder.join("campaign.toml"), manifest.as_bytes())
}
