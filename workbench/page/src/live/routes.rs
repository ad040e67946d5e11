//! HTTP routes of the closed loop.

use std::sync::Arc;

use axum::extract::State;
use axum::response::Response;
use axum::routing::{get, post};
use axum::{Json, Router};
use hitch_closed_loop::driven::{Described, Machine, Orders, wrong_advance};
use hitch_controller_host::calibration_file;
use serde::Deserialize;
use serde_json::json;

use super::answer::LoopAnswer;
use super::loop_source::LoopSource;
use crate::refusal::Refusal;
use crate::request::{Answer, InBody, InQuery, Known, blocking, done, lock};
use crate::saving::{TOML, attached};
use hitch_output::error::Error;

/// All routes of the closed loop.
pub fn routes() -> Router<Arc<crate::sessions::Sessions>> {
    Router::new()
        .route("/{token}/api/loop/describe", post(describe))
        .route("/{token}/api/loop/open", post(open))
        .route("/{token}/api/loop/close", post(close))
        .route("/{token}/api/loop/step", post(step))
        .route("/{token}/api/loop/write", post(write))
        .route("/{token}/api/calibration", get(calibration))
}

/// Conditions at the start.
#[derive(Debug, Deserialize)]
struct Open {
    orders: Orders,
}

/// What the page draws before it starts anything.
async fn describe(
    State(sessions): Known,
    InBody(session, wanted): InBody<Open>,
) -> Answer<Described> {
    let orders = checked(wanted.orders)?;
    let models = lock(&session).models();
    let shown = blocking(move || {
        let machine = models.machine()?;
        view(&machine, machine.start_deg(&orders), &sessions.loop_source)
    });
    Ok(Json(shown.await??))
}

/// Starts a closed loop at rest with the lever at its position; replaces that of before.
async fn open(State(sessions): Known, InBody(session, wanted): InBody<Open>) -> Answer<Described> {
    let orders = checked(wanted.orders)?;
    let (of, models, before) = {
        let mut session = lock(&session);
        (
            Arc::clone(&session.present().evaluated),
            session.models(),
            session.tab_loop.take(),
        )
    };
    let started = blocking(move || {
        drop(before);
        let machine = models.machine()?;
        if let Some(what) = machine.refusal(&orders) {
            return Err(Refusal::wrong(what));
        }
        let angle_deg = machine.start_deg(&orders);
        let source = &sessions.loop_source;
        let shown = view(&machine, angle_deg, source)?;
        Ok::<_, Refusal>((source.start(of, machine, orders, angle_deg)?, shown))
    });
    let (tab_loop, shown) = started.await??;
    lock(&session).tab_loop = Some(tab_loop);
    Ok(Json(shown))
}

/// Ends the closed loop.
async fn close(InBody(session, _): InBody) -> Answer {
    let before = lock(&session).tab_loop.take();
    blocking(move || drop(before)).await?;
    done()
}

/// Writes the calibration of the present model to the ECU on the bus.
async fn write(State(sessions): Known, InBody(session, _): InBody) -> Answer {
    let models = lock(&session).models();
    let written = blocking(move || {
        let rebuilt = models.rebuilt()?;
        sessions.loop_source.write(&rebuilt)
    });
    let written = written.await??;
    Ok(Json(
        json!({ "changed": written.changed, "words": written.words }),
    ))
}

/// The description of a machine whose hitches begin at an angle, degree.
fn view(machine: &Machine, angle_deg: f64, source: &LoopSource) -> Result<Described, Error> {
    Described::new(machine, angle_deg, source.name(), source.may_write())
        .map_err(|error| Error::Failed(format!("the linkage cannot be drawn: {error}")))
}

/// An advance of both hitches.
#[derive(Debug, Deserialize)]
struct Advance {
    orders: Orders,
    milliseconds: u32,
}

async fn step(InBody(session, wanted): InBody<Advance>) -> Answer<LoopAnswer> {
    let orders = checked(wanted.orders)?;
    if let Some(what) = wrong_advance(wanted.milliseconds) {
        return Err(Refusal::wrong(what));
    }
    let pending = {
        let session = lock(&session);
        let tab_loop = session.tab_loop.as_ref();
        let tab_loop = tab_loop.filter(|known| session.is_present(&known.of));
        let stale = || Refusal::conflict("the model has changed; start the closed loop again");
        let tab_loop = tab_loop.ok_or_else(stale)?;
        tab_loop.advance(orders, wanted.milliseconds)?
    };
    let advanced = blocking(move || pending.wait()).await?;
    Ok(Json(advanced?))
}

/// The orders, if all values are in range.
fn checked(orders: Orders) -> Result<Orders, Refusal> {
    match orders.fault() {
        Some(what) => Err(Refusal::wrong(what)),
        None => Ok(orders),
    }
}

/// The calibration of the present model, as a file.
async fn calibration(InQuery(session, _): InQuery) -> Result<Response, Refusal> {
    let models = lock(&session).models();
    let rebuilt = blocking(move || models.rebuilt()).await??;
    Ok(attached(
        TOML,
        "calibration.toml",
        calibration_file::write(&rebuilt),
    ))
}
