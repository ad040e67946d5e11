//! Good campaigns have no finding.

use std::path::{Path, PathBuf};

use hitch_campaign::Campaign;
use hitch_measurement::check;
use hitch_model_file::named;

#[test]
fn good_campaigns_have_no_finding() {
    for folder in folders() {
        let campaign = Campaign::load(&folder).expect("a campaign");
        for model in [None, Some(named("nominal").expect("a model"))] {
            let found = check(&campaign, model.as_ref());
            assert!(found.is_empty(), "{}: {found:#?}", folder.display());
        }
    }
}

#[test]
fn a_channel_of_a_lower_rate_has_no_finding() {
    for folder in folders() {
        let mut campaign = Campaign::load(&folder).expect("a campaign");
        for run in &mut campaign.runs {
            let slow = run.channels.iter_mut().flatten().skip(1);
            for value in slow.flat_map(|values| values.iter_mut().enumerate()) {
                if value.0 % 5 != 0 {
                    *value.1 = f64::NAN;
                }
            }
        }
        let found = check(&campaign, None);
        assert!(found.is_empty(), "{}: {found:#?}", folder.display());
    }
}

/// The demonstration, and the campaigns of the acceptance tests: soft oil, friction, rough ground, leakage, air.
fn folders() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let entries = root
        .join("host-tests/campaigns")
        .read_dir()
        .expect("a folder");
    let folders = entries.map(|entry| entry.expect("an entry").path());
    let mut folders: Vec<PathBuf> = folders.filter(|path| path.is_dir()).collect();
    folders.push(root.join("workbench/data/demonstration"));
    assert!(folders.len() > 10);
    folders
}
