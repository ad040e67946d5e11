//! The report of `hitch draft`: draft over speed by depth, and the tables.

use hitch_draft::block::Block;
use maud::{Markup, html};

use super::chart::{Chart, Points, Stroke};
use super::drawn::drawn;
use super::page;
use crate::draft::DraftResult;

/// Points of a drawn curve.
const POINTS: u32 = 40;

/// The whole page.
#[must_use]
pub fn page(result: &DraftResult) -> String {
    let title = format!("Draft of {}", result.campaign);
    let content = html! {
        h1 { (title) }
        p.lead { (result.sentence()) }
        (charts(result))
        p.note { "Bars: mean and standard deviation of a run, with the hidden effects if there are any. The law is without them." }
        h2 { "Coefficients" }
        (page::table(&DraftResult::COEFFICIENTS, result.coefficient_rows()))
        h2 { "Hidden effects" }
        (page::table(&DraftResult::EFFECTS, result.effect_rows()))
        @for remark in result.remarks() { p { (remark) } }
    };
    page::page(&title, &content)
}

/// A run as it is drawn: means of depth and speed, mean and standard deviation of the draft.
struct Drive {
    depth_cm: f64,
    speed_km_h: f64,
    draft_kn: f64,
    deviation_kn: f64,
}

/// A chart for each depth: runs whose mean depths differ by less than a tenth share one.
fn charts(result: &DraftResult) -> Markup {
    let mut drives = drives(result);
    drives.sort_by(|left, right| left.depth_cm.total_cmp(&right.depth_cm));
    let groups = drives.chunk_by(|left, right| right.depth_cm < 1.1 * left.depth_cm);
    let speeds = drives.iter().map(|drive| drive.speed_km_h);
    let (slowest, fastest) = speeds.fold((f64::INFINITY, 0.0_f64), |(low, high), speed| {
        (low.min(speed), high.max(speed))
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
        // A gap separates the bars.
        let bar = |drive: &Drive| {
            let (low, high) = (
                drive.draft_kn - drive.deviation_kn,
                drive.draft_kn + drive.deviation_kn,
            );
            [low, drive.draft_kn, high, f64::NAN].map(|draft_kn| (drive.speed_km_h, draft_kn))
        };
        let measured: Points = group.iter().flat_map(bar).unzip();
        let line = |name: &str, stroke, points| (name.to_owned(), stroke, points);
        Chart {
            caption: format!("Draft at {depth_cm:.0} cm"),
            axes: ["speed, km/h", "draft, kN"],
            lines: vec![
                line("measured", Stroke::Measured, measured),
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
    let charts: Vec<Chart<'static>> = groups.map(chart).collect();
    drawn("Draft over speed by depth", &charts)
}

fn drives(result: &DraftResult) -> Vec<Drive> {
    let in_soil = result.fit.blocks.iter().filter(|block| block.in_soil);
    let in_soil: Vec<&Block> = in_soil.collect();
    let drive = |blocks: &[&Block]| {
        let mean = |value: &dyn Fn(&Block) -> f64| {
            blocks.iter().map(|block| value(block)).sum::<f64>() / blocks.len() as f64
        };
        let draft_kn = mean(&|block| 1e-3 * block.draft_n);
        Drive {
            depth_cm: mean(&|block| block.depth_cm),
            speed_km_h: mean(&|block| block.speeds[1]),
            draft_kn,
            deviation_kn: mean(&|block| (1e-3 * block.draft_n - draft_kn).powi(2)).sqrt(),
        }
    };
    in_soil
        .chunk_by(|left, right| left.run == right.run)
        .map(drive)
        .collect()
}
