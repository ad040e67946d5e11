//! Folders with a manifest and logs: what is read, and where a fault is.

use std::fs;

use hitch_draft::fit::{Verdict, fit};
use hitch_draft::machine::{KINDS, Machine};
use hitch_draft::manifest::Campaign;
use hitch_draft::next_run::NextRun;
use hitch_draft::simulated::{Pass, Truth, runs};
use hitch_draft::term::Term;
use hitch_field::draft::Texture;
use tempfile::TempDir;

const MANIFEST: &str = "format = 1\n[implement]\nkind = \"mouldboard-plough\"\nwidth_m = 1.2\n[soil]\ntexture = \"medium\"\n";
const RUN: &str = "[[run]]\nfile = \"a.csv\"\n";
const LOG: &str = "time_s,speed_km_h,depth_cm,draft_kn\n0,7.2,20,15\n0.5,7.2,20,16\n";

fn folder(manifest: &str, log: &str) -> TempDir {
    let dir = TempDir::new().unwrap();
    fs::write(dir.path().join("campaign.toml"), manifest).unwrap();
    fs::write(dir.path().join("a.csv"), log).unwrap();
    dir
}

#[test]
fn units_of_the_header_are_converted() {
    let foreign = "[columns]\ntime = \"t\"\nspeed = \"v\"\ndepth = \"Tiefe:mm\"\ndraft = [\"links\", \"rechts:daN\"]\n";
    let foreign = foreign.replace("daN", "kN");
    let log = "t [ms];v [km/h];Tiefe;links [N];rechts\n0;7,2;200;10000;5\n500;7,2;200;10000;6\n";
    for (manifest, log) in [
        (format!("{MANIFEST}{RUN}"), LOG),
        (format!("{MANIFEST}{foreign}{RUN}"), log),
    ] {
        let dir = folder(&manifest, log);
        let campaign = Campaign::load(dir.path()).unwrap();
        let last = campaign.runs[0].samples[1];
        assert!((last.time_s - 0.5).abs() < 1e-9);
        assert!((last.speed_m_s - 2.0).abs() < 1e-9, "{last:?}");
        assert!((last.depth_m - 0.2).abs() < 1e-9);
        assert!((last.draft_n - 16_000.0).abs() < 1e-6);
    }
}

#[test]
fn a_fault_says_where_it_is_and_how_to_mend_it() {
    let manifest = format!("{MANIFEST}{RUN}");
    for (manifest, log, expected) in [
        (
            manifest.replace("mouldboard-plough", "mouldboard"),
            LOG,
            "campaign.toml:3:8: kind \"mouldboard\" is not known; did you mean",
        ),
        (
            manifest.replace("width_m", "tools"),
            LOG,
            "campaign.toml:4:9: the standard does not count tools",
        ),
        (
            manifest.replace("medium", "loam"),
            LOG,
            "campaign.toml:6:11: texture \"loam\" is not known",
        ),
        (
            manifest.replace("a.csv", "b.csv"),
            LOG,
            "campaign.toml:8:8: the folder contains no file \"b.csv\"",
        ),
        (
            manifest.clone(),
            "time_s,speed_km_h,depth_cm\n0,7,20\n1,7,20\n",
            "a.csv:1:1: the header has no column of the draft; name it draft_n",
        ),
        (
            manifest.clone(),
            "time_s,speed,depth_cm,draft_kn\n0,7,20,15\n1,7,20,16\n",
            "a.csv:1:1: \"speed\" has no unit",
        ),
        (
            manifest.clone(),
            "time_s,speed_m_s,depth_cm,draft_kn\n0,2,20,15\n1,2,x,16\n2,2,20,16\n",
            "a.csv:3:5: the cell of \"depth_cm\" is not a number",
        ),
        (
            manifest.clone(),
            "time_s,speed_m_s,depth_m,draft_kn\n0,2,0.2,15\n1,2,20,16\n",
            "a.csv:3:5: \"depth_m\" is 20 m, which is out of range",
        ),
        (
            manifest.clone(),
            "time_s,speed_m_s,depth_m,draft_kn\n1,2,0.2,15\n1,2,0.2,16\n",
            "a.csv:3:1: time 1 s is not later",
        ),
    ] {
        let dir = folder(&manifest, log);
        let fault = Campaign::load(dir.path()).unwrap_err().to_string();
        let shown = fault.replace(&format!("{}/", dir.path().display()), "");
        assert!(shown.starts_with(expected), "{shown}\nexpected {expected}");
    }
}

fn plough() -> Truth {
    Truth::standard(Machine {
        kind: KINDS[1],
        width: 1.2,
        texture: Texture::Medium,
    })
}

/// At one depth, blunt shares and the soil have the same signature; without a run above the soil, so has the sensor's zero. The
/// effects stay open, and the proposed run decides.
#[test]
fn what_one_depth_cannot_separate_stays_open_and_the_named_run_decides() {
    let pass = |depth_m, speed_km_h| Pass {
        depth_m,
        speed_km_h,
        length_m: 60.0,
    };
    let mut truth = plough();
    truth.draft_zero_n = 3000.0;
    let mut passes = vec![
        pass(0.22, 5.0),
        pass(0.22, 6.5),
        pass(0.22, 8.0),
        pass(0.22, 6.5),
    ];
    let first = fit(&truth.machine, &runs(&truth, &passes, 3)).unwrap();
    let of = |fit: &hitch_draft::fit::Fit, term| {
        let mut effects = fit.effects.iter();
        effects
            .find(|effect| effect.term == term)
            .unwrap()
            .verdict()
    };
    assert_eq!(of(&first, Term::BluntShare), Verdict::Open);
    assert_eq!(of(&first, Term::DraftZero), Verdict::Open);
    let next = first.next_run.expect("something is open");
    assert_eq!(next, NextRun::Raised, "a raised run shows the zero alone");
    passes.push(pass(-0.2, 6.0));
    let second = fit(&truth.machine, &runs(&truth, &passes, 3)).unwrap();
    assert_eq!(of(&second, Term::DraftZero), Verdict::Present);
}
