//! Two models compared in the page of `hitch serve`, without a browser.

use host_tests::page_server::PageServer;
use serde_json::{Value, json};
use tempfile::TempDir;

/// A tab.
struct Tab<'s> {
    server: &'s PageServer,
    session: String,
}

impl<'s> Tab<'s> {
    fn new(server: &'s PageServer) -> Self {
        let session = server.begin();
        Self { server, session }
    }

    fn post(&self, path: &str, mut body: Value) -> u16 {
        body["session"] = json!(self.session);
        self.server.post(&format!("api/{path}"), &body).status
    }

    fn get(&self, path: &str, query: &str) -> Value {
        let session = &self.session;
        let path = format!("api/{path}?session={session}&{query}");
        self.server.get(&path).json()
    }

    fn state(&self) -> Value {
        self.server.settled(&self.session)
    }

    fn model(&self) -> String {
        let path = format!("api/model?session={}", self.session);
        self.server.get(&path).body
    }

    fn send(&self, name: &str, text: &str) -> (u16, Value) {
        let query = format!("session={}&name={name}", self.session);
        let answer = self.server.send(&format!("api/second/file?{query}"), text);
        (
            answer.status,
            serde_json::from_str(&answer.body).unwrap_or_default(),
        )
    }

    fn add(&self, effect: &str) -> Value {
        let task = json!({ "task": "add", "effect": effect });
        assert_eq!(self.post("start", task), 200);
        self.state()
    }
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value}"))
}

#[test]
fn an_earlier_step_is_compared_swapped_and_closed_beside_another_tab() {
    let dir = TempDir::new().unwrap();
    let server = PageServer::start(dir.path(), &[]);
    let (tab, other) = (Tab::new(&server), Tab::new(&server));
    assert!(tab.state()["second"].is_null());
    assert_eq!(tab.post("second/swap", json!({})), 409);
    assert_eq!(tab.post("second/step", json!({ "at": 1 })), 409);
    let first = tab.get("run", "run=0")["channels"].clone();
    let state = tab.add("lower-threshold-shift");
    assert_eq!(tab.post("second/step", json!({ "at": 0 })), 200);

    let compared = tab.state()["second"].clone();
    assert_eq!(
        (&compared["step"], &compared["is_after"]),
        (&json!(0), &json!(false))
    );
    assert_eq!(compared["before"], state["steps"][0]["error"]);
    assert_eq!(compared["after"], state["error"]);
    for (channel, present) in compared["channels"]
        .as_array()
        .unwrap()
        .iter()
        .zip(state["channels"].as_array().unwrap())
    {
        assert_eq!(
            (&channel["key"], &channel["after"]),
            (&present["key"], &present["error"])
        );
    }

    // The cell that gets better most, and the stretch of it that contributes most.
    let changes = compared["changes"].as_array().unwrap();
    assert_eq!(changes.len(), state["cells"].as_array().unwrap().len());
    let gain = |cell: &Value| number(&cell["before"]) - number(&cell["after"]);
    let best = changes
        .iter()
        .max_by(|a, b| gain(a).total_cmp(&gain(b)))
        .unwrap();
    let query = |cell: &Value| {
        let text = |key: &str| cell[key].as_str().unwrap().replace(' ', "%20");
        format!(
            "by={}&part={}&channel={}",
            text("by"),
            text("part"),
            text("channel")
        )
    };
    let found = tab.get("second/largest", &query(best));
    let stretch = &found["stretch"];
    assert!(gain(stretch) >= gain(best), "{found} {best}");

    // Both simulations of one run over one measurement; the second one is that of the first step.
    let run = tab.get("run", "run=0");
    for (channel, first) in run["channels"]
        .as_array()
        .unwrap()
        .iter()
        .zip(first.as_array().unwrap())
    {
        for key in ["simulated", "residual", "error"] {
            assert_eq!(channel["second"][key], first[key], "{key}");
        }
        assert_eq!(channel["measured"], first["measured"]);
    }

    assert_eq!(tab.post("second/swap", json!({})), 200);
    let swapped = tab.state()["second"].clone();
    assert_eq!(
        (&swapped["before"], &swapped["after"]),
        (&compared["after"], &compared["before"])
    );
    assert!(other.state()["second"].is_null());
    assert_eq!(tab.post("second/close", json!({})), 200);
    assert!(tab.state()["second"].is_null());
    assert!(tab.get("run", "run=0")["channels"][0]["second"].is_null());
}

#[test]
fn a_model_file_is_evaluated_on_the_campaign_of_the_tab() {
    let dir = TempDir::new().unwrap();
    let server = PageServer::start(dir.path(), &[]);
    let (tab, other) = (Tab::new(&server), Tab::new(&server));
    let initial = tab.model();
    assert_eq!(tab.send("initial.toml", &initial).0, 200);
    let same = tab.state()["second"].clone();
    assert_eq!(
        (&same["title"], &same["step"]),
        (&json!("initial.toml"), &Value::Null)
    );
    for cell in same["changes"].as_array().unwrap() {
        assert_eq!(cell["before"], cell["after"], "the same model in {cell}");
    }

    let fitted = other.add("lower-threshold-shift");
    assert_eq!(tab.send("fitted.toml", &other.model()).0, 200);
    let compared = tab.state();
    let second = &compared["second"];
    assert!(
        (number(&second["before"]) - number(&fitted["error"])).abs() < 0.05,
        "{}",
        second["before"]
    );
    assert!(number(&second["after"]) > 5.0 && second["after"] == compared["error"]);
    assert_eq!(
        compared["steps"].as_array().unwrap().len(),
        1,
        "the history is that of before"
    );
    assert!(other.state()["second"].is_null());
}

// REQ-INPUT-04
#[test]
fn a_broken_model_file_shows_where_and_keeps_the_comparison() {
    let dir = TempDir::new().unwrap();
    let server = PageServer::start(dir.path(), &[]);
    let tab = Tab::new(&server);
    assert_eq!(tab.post("second/step", json!({ "at": 0 })), 200);
    let sound = tab.model();
    let line = sound
        .lines()
        .position(|line| line.contains("_mm = "))
        .unwrap();
    let lines: Vec<&str> = sound.lines().collect();
    let column = lines[line].find("= ").unwrap() + 3;
    let oops = format!("{}= \"oops\"", &lines[line][..column - 3]);
    let broken = sound.replacen(lines[line], &oops, 1);
    let (status, answer) = tab.send("broken.toml", &broken);
    assert_eq!(status, 422);
    let fault = &answer["fault"];
    assert_eq!(
        (&fault["file"], &fault["line"], &fault["column"]),
        (&json!("broken.toml"), &json!(line + 1), &json!(column)),
        "{fault}"
    );
    assert_eq!(tab.send("log.csv", "time_s,flow_lpm\n0,1\n").0, 422);
    assert_eq!(tab.send("huge.toml", &"#".repeat(2 << 20)).0, 413);
    assert_eq!(tab.state()["second"]["step"], 0);
}
