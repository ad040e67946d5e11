//! The report of `hitch draft`: draft over speed by depth, and the tables.

use maud::{Markup, html};

use super::chart::Stroke;
use super::drawn::{Drawn, Points, drawn};
use super::page;
use crate::draft::DraftResult;

/// Points of a drawn curve.
const POINTS: u32 = 40;
/// Metres of a run that are drawn as one point.
const METRES: usize = 10;

/// The whole page.
#[must_use]
pub fn page(result: &DraftResult) -> String {
    let rows = |rows: Vec<[String; 5]>| -> Vec<Vec<String>> {
        rows.into_iter().map(|row| row.to_vec()).collect()
    };
    let title = format!("Draft of {}", result.campaign);
    let content = html! {
        h1 { (title) }
        p.lead { (result.sentence()) }
        (charts(result))
        h2 { "Coefficients" }
        (page::table(&DraftResult::COEFFICIENTS, &rows(result.coefficient_rows())))
        h2 { "Hidden effects" }
        (page::table(&DraftResult::EFFECTS, &rows(result.effect_rows())))
        @for remark in result.remarks() { p { (remark) } }
    };
    page::page(&title, &content)
}

/// A run as it is drawn: its mean depth, and its means of ten metres.
struct Drive {
    depth_cm: f64,
    points: Points,
}

/// A chart for each depth: runs whose mean depths differ by less than a tenth share one.
fn charts(result: &DraftResult) -> Markup {
    let mut drives = drives(result);
    drives.sort_by(|left, right| left.depth_cm.total_cmp(&right.depth_cm));
    let groups = drives.chunk_by(|left, right| right.depth_cm < 1.1 * left.depth_cm);
    let speeds = drives.iter().flat_map(|drive| &drive.points.0);
    let (slowest, fastest) = speeds.fold((f64::INFINITY, 0.0_f64), |(low, high), speed| {
        (low.min(*speed), high.max(*speed))
    });
    let at = |index: u32| slowest + (fastest - slowest) * f64::from(index) / f64::from(POINTS);
    let chart = |group: &[Drive]| {
        let depth_cm = group.iter().map(|drive| drive.depth_cm).sum::<f64>() / group.len() as f64;
        let fit = &result.fit;
        let curve = |value: &dyn Fn(f64) -> f64| -> Points {
            (0..=POINTS)
                .map(at)
                .map(|speed| (speed, 1e-3 * value(speed)))
                .unzip()
        };
        let law = |speed| DraftResult::draft(fit, depth_cm, speed);
        // A gap separates the runs.
        let mut measured: Points = Points::default();
        for drive in group {
            measured
                .0
                .extend(drive.points.0.iter().chain(drive.points.0.last()));
            measured.1.extend(drive.points.1.iter().chain([&f64::NAN]));
        }
        let line = |name: &str, stroke, points| (name.to_owned(), stroke, points);
        Drawn {
            caption: format!("Draft at {depth_cm:.0} cm"),
            axes: ["speed, km/h", "draft, kN"],
            lines: vec![
                line("measured, means of 10 m", Stroke::Measured, measured),
                line(
                    "law of the campaign",
                    Stroke::After,
                    curve(&|speed| law(speed).value),
                ),
                line("95 % low", Stroke::Other, curve(&|speed| law(speed).low)),
                line("95 % high", Stroke::Other, curve(&|speed| law(speed).high)),
                line(
                    "standard",
                    Stroke::Before,
                    curve(&|speed| DraftResult::standard_draft(fit, depth_cm, speed)),
                ),
            ],
        }
    };
    let charts: Vec<Drawn> = groups.map(chart).collect();
    drawn("Draft over speed by depth", &charts)
}

fn drives(result: &DraftResult) -> Vec<Drive> {
    let in_soil: Vec<_> = result
        .fit
        .blocks
        .iter()
        .filter(|block| block.in_soil)
        .collect();
    let drive = |blocks: &[&hitch_draft::block::Block]| {
        let mean = |blocks: &[&hitch_draft::block::Block],
                    value: fn(&hitch_draft::block::Block) -> f64| {
            blocks.iter().map(|block| value(block)).sum::<f64>() / blocks.len() as f64
        };
        let mut points: Vec<(f64, f64)> = blocks
            .chunks(METRES)
            .map(|part| {
                (
                    mean(part, |block| block.speeds[1]),
                    1e-3 * mean(part, |block| block.draft_n),
                )
            })
            .collect();
        points.sort_by(|left, right| left.0.total_cmp(&right.0));
        Drive {
            depth_cm: mean(blocks, |block| block.depth_cm),
            points: points.into_iter().unzip(),
        }
    };
    in_soil
        .chunk_by(|left, right| left.run == right.run)
        .map(drive)
        .collect()
}
