//! HTTP routes of the closed loop.

use std::sync::Arc;

use axum::extract::{Query, State};
use axum::http::{StatusCode, header};
use axum::response::{IntoResponse, Response};
use axum::routing::{get, post};
use axum::{Json, Router};
use hitch_controller_host::calibration_file;
use serde::Deserialize;
use serde_json::json;

use super::bench::{Bench, NoAnswer};
use super::description::described;
use super::machine::Models;
use super::orders::{LONGEST_MS, Orders};
use crate::error::Error;
use crate::serve::routes::{Answer, Known, Of, Refusal, blocking, find, lock};

/// All routes of the closed loop.
pub fn routes() -> Router<Arc<crate::serve::sessions::Sessions>> {
    Router::new()
        .route("/{token}/api/loop/open", post(open))
        .route("/{token}/api/loop/step", post(step))
        .route("/{token}/api/calibration", get(calibration))
}

/// Conditions at the start.
#[derive(Debug, Deserialize)]
struct Open {
    session: String,
    orders: Orders,
}

/// Starts both hitches at rest with the lever at their position; replaces those of before.
async fn open(State(sessions): Known, Json(wanted): Json<Open>) -> Answer {
    let session = find(&sessions, &wanted.session)?;
    let orders = checked(wanted.orders)?;
    let (of, models) = {
        let session = lock(&session);
        (
            Arc::clone(&session.present().evaluated),
            Models::of(&session),
        )
    };
    let started = blocking(move || {
        let machine = models.machine()?;
        let (low_rad, high_rad) = machine.plant.linkage().swing_rad();
        let (low_deg, high_deg) = (low_rad.to_degrees(), high_rad.to_degrees());
        let angle_deg = orders.lever_deg.clamp(low_deg, high_deg);
        let view = described(&machine, angle_deg)?;
        let no_thread = |error| Error::Failed(format!("the simulation cannot be started: {error}"));
        let bench = Bench::start(of, machine, orders, angle_deg).map_err(no_thread)?;
        Ok::<_, Error>((bench, view))
    });
    let (bench, view) = started.await??;
    lock(&session).bench = Some(bench);
    Ok(Json(view))
}

/// An advance of both hitches.
#[derive(Debug, Deserialize)]
struct Advance {
    session: String,
    orders: Orders,
    milliseconds: u32,
}

async fn step(State(sessions): Known, Json(wanted): Json<Advance>) -> Answer {
    let session = find(&sessions, &wanted.session)?;
    let orders = checked(wanted.orders)?;
    if !(1..=LONGEST_MS).contains(&wanted.milliseconds) {
        let what = format!(
            "milliseconds is {}; it has to be from 1 to {LONGEST_MS}",
            wanted.milliseconds
        );
        return Err(Refusal::wrong(json!({ "what": what })));
    }
    let pending = {
        let session = lock(&session);
        let present = &session.present().evaluated;
        let bench = session.bench.as_ref();
        let bench = bench.filter(|bench| Arc::ptr_eq(&bench.of, present));
        let stale = || Refusal::conflict("the model has changed; start the closed loop again");
        let bench = bench.ok_or_else(stale)?;
        bench
            .advance(orders, wanted.milliseconds)
            .map_err(refused)?
    };
    let advanced = blocking(move || pending.wait()).await?;
    Ok(Json(advanced.map_err(refused)?))
}

/// The orders, if all values are in range.
fn checked(orders: Orders) -> Result<Orders, Refusal> {
    match orders.fault() {
        Some(what) => Err(Refusal::wrong(json!({ "what": what }))),
        None => Ok(orders),
    }
}

fn refused(reason: NoAnswer) -> Refusal {
    match reason {
        NoAnswer::Busy => Refusal::of(
            StatusCode::TOO_MANY_REQUESTS,
            "an earlier step of the closed loop has not ended",
        ),
        NoAnswer::Failed => Refusal::of(
            StatusCode::INTERNAL_SERVER_ERROR,
            "the simulation has failed; start the closed loop again",
        ),
    }
}

/// The calibration of the present model, as a file.
async fn calibration(State(sessions): Known, Query(of): Query<Of>) -> Result<Response, Refusal> {
    let session = find(&sessions, &of.session)?;
    let models = Models::of(&lock(&session));
    let rebuilt = blocking(move || models.rebuilt()).await??;
    let headers = [
        (header::CONTENT_TYPE, "application/toml; charset=utf-8"),
        (
            header::CONTENT_DISPOSITION,
            "attachment; filename=\"calibration.toml\"",
        ),
    ];
    Ok((headers, calibration_file::write(&rebuilt)).into_response())
}
