//! A tab of the page with its closed loop, accessed as by a browser.

use serde_json::{Value, json};

use crate::page_server::{Answer, PageServer};

/// A tab with its closed loop.
#[derive(Debug)]
pub struct LoopTab<'s> {
    /// The server of the page.
    pub server: &'s PageServer,
    /// Id of its session.
    pub session: String,
    /// Controls and conditions, as the page sends them.
    pub orders: Value,
}

impl<'s> LoopTab<'s> {
    /// A new session with the lever in the middle.
    #[must_use]
    pub fn new(server: &'s PageServer) -> Self {
        Self {
            server,
            session: server.begin(),
            orders: json!({ "lever_deg": 90.0, "load_kg": 150.0, "oil_temperature_c": 40.0 }),
        }
    }

    /// Posts the orders to a route of the closed loop.
    #[must_use]
    pub fn post(&self, what: &str, milliseconds: i64) -> Answer {
        let body = json!({
            "session": self.session, "orders": self.orders, "milliseconds": milliseconds
        });
        self.server.post(&format!("api/loop/{what}"), &body)
    }
}
