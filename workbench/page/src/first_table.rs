//! The first model with a flow curve or a linkage from a table of a data sheet or a flow bench.

use std::path::Path;
use std::sync::Arc;

use axum::body::Bytes;
use axum::extract::DefaultBodyLimit;
use axum::routing::post;
use axum::{Json, Router};
use hitch_input::source_file::SourceFile;
use hitch_model_file::Template;
use hitch_plant::{Model, Valve};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::first::{LARGEST_MODEL, exchange, made};
use super::request::{Answer, InQuery, blocking, lock};
use super::sessions::Sessions;
use hitch_output::error::Error;
use hitch_results::base_model::{flow_curve, linkage_table};

/// The route of tables.
pub fn routes() -> Router<Arc<Sessions>> {
    let table = post(table).layer(DefaultBodyLimit::max(LARGEST_MODEL));
    Router::new().route("/{token}/api/first/table", table)
}

/// What a table is of.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "lowercase")]
enum Subject {
    /// The flow curve of the lift valve.
    Lift,
    /// That of the lowering valve.
    Lower,
    /// The linkage.
    Linkage,
}

#[derive(Debug, Deserialize)]
struct OfTable {
    name: String,
    of: Subject,
}

/// A table that was taken.
#[derive(Debug, Serialize, JsonSchema)]
pub(super) struct TakenTable {
    /// Its points and ranges, in words.
    said: String,
}

async fn table(InQuery(session, asked): InQuery<OfTable>, body: Bytes) -> Answer<TakenTable> {
    let before = lock(&session).subject().model.clone();
    let read = move || with_table(&before, asked.of, &asked.name, &body);
    let (model, said) = blocking(read).await??;
    let _ = exchange(session, model).await?;
    Ok(Json(TakenTable { said }))
}

/// The model with a table, and what was taken.
///
/// # Errors
/// A fault of the table, by line; or it makes no machine.
fn with_table(
    before: &Model,
    of: Subject,
    name: &str,
    bytes: &[u8],
) -> Result<(Model, String), Error> {
    let source = SourceFile::any_of(Path::new(name), bytes)?;
    let mut template = Template::of(&before.name, before);
    let mut curve = |valve| -> Result<String, Error> {
        let curve = flow_curve::of(&source)?;
        let said = format!(
            "{} points, opens at {:.2} A, {:.1} l/min at {:.2} A",
            curve.currents_a().len(),
            curve.threshold_a(),
            curve.flows_m3_s().last().copied().unwrap_or_default() * 60e3,
            curve.currents_a().last().copied().unwrap_or_default(),
        );
        template.set_curve(valve, curve);
        Ok(said)
    };
    let said = match of {
        Subject::Lift => format!("Lift valve from {name}: {}", curve(Valve::Lift)?),
        Subject::Lower => format!("Lowering valve from {name}: {}", curve(Valve::Lower)?),
        Subject::Linkage => {
            let linkage = linkage_table::of(&source)?;
            let (from_m, to_m) = linkage.span_m();
            template.set_linkage(linkage);
            format!(
                "Linkage from {name}: travel {:.0} to {:.0} mm",
                1e3 * from_m,
                1e3 * to_m
            )
        }
    };
    let model = made(&format!("{name} makes"), &template, &before.name)?;
    Ok((model, said))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_of_another_unit_replaces_that_of_its_valve() {
        let before = hitch_model_file::dynamic();
        let text = b"Strom [mA];Durchfluss [l/min]\n0;0\n1500;0\n2000;20,0\n";
        let (model, said) =
            with_table(&before, Subject::Lower, "curve.csv", text).expect("a curve");
        let curve = &model.constants().lower_valve.curve;
        assert!(
            (curve.threshold_a() - 1.5).abs() < 1e-12 && said.contains("20.0 l/min at 2.00 A"),
            "{said}"
        );
        assert_eq!(model.constants().lift_valve, before.constants().lift_valve);
        let fault =
            with_table(&before, Subject::Lift, "curve.csv", b"a,b\n1,2\n").expect_err("no curve");
        assert!(fault.to_string().contains("curve.csv:1"), "{fault}");
    }

    #[test]
    fn a_measured_linkage_replaces_the_dimensions_and_the_stroke() {
        let text = b"travel_mm,angle_deg,height_mm\n0,45,-850\n80,90,-520\n160,136,-170\n";
        let before = hitch_model_file::nominal();
        let (model, _) =
            with_table(&before, Subject::Linkage, "linkage.csv", text).expect("a linkage");
        assert!((model.constants().cylinder.stroke_m - 0.16).abs() < 1e-12);
        let (low_rad, high_rad) = model.linkage().swing_rad();
        assert!(
            (low_rad.to_degrees() - 45.0).abs() < 1e-6
                && (high_rad.to_degrees() - 136.0).abs() < 1e-6
        );
    }
}
