//! `hitch serve`, accessed as by a browser.
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Stdio};
use std::time::Duration;

use serde_json::Value;

use crate::program::hitch;

/// How long an answer may take on a machine with other work.
const PATIENCE: Duration = Duration::from_secs(120);

/// A running server; it ends when dropped.
#[derive(Debug)]
pub struct PageServer {
    program: Child,
    /// Address of the page.
    pub page: String,
    /// Its host and port.
    pub host: String,
    /// Its path, with slashes at both ends.
    pub path: String,
}

/// Response of the server.
#[derive(Debug)]
pub struct Answer {
    /// Status code.
    pub status: u16,
    /// Header lines.
    pub head: String,
    /// Body.
    pub body: String,
}

impl Answer {
    /// The body as JSON.
    ///
    /// # Panics
    /// If it is none.
    #[must_use]
    pub fn json(&self) -> Value {
        serde_json::from_str(&self.body).unwrap_or_else(|error| panic!("{error}: {}", self.body))
    }
}

impl PageServer {
    /// Starts it in a folder with arguments.
    ///
    /// # Panics
    /// If it does not start.
    #[must_use]
    pub fn start(folder: &Path, arguments: &[&str]) -> Self {
        Self::start_with(folder, arguments, &[])
    }

    /// Starts it in a folder with arguments and paths in environment variables.
    ///
    /// # Panics
    /// If it does not start.
    #[must_use]
    pub fn start_with(folder: &Path, arguments: &[&str], variables: &[(&str, &Path)]) -> Self {
        let mut command = hitch();
        command.envs(variables.iter().copied());
        command.arg("serve").arg("--no-browser").args(arguments);
        command.current_dir(folder).stdout(Stdio::piped());
        let mut program = command.spawn().expect("hitch starts");
        let mut page = String::new();
        let said = program.stdout.as_mut().expect("it has an output");
        BufReader::new(said)
            .read_line(&mut page)
            .expect("it prints the address");
        let page = page.trim().to_owned();
        let address = page.strip_prefix("http://").expect("an address");
        let (host, path) = address.split_once('/').expect("a path");
        let (host, path) = (host.to_owned(), format!("/{path}"));
        Self {
            program,
            page,
            host,
            path,
        }
    }

    /// Sends a request with just these headers, and a body if there is one.
    ///
    /// # Panics
    /// If there is no answer.
    #[must_use]
    pub fn request(&self, line: &str, headers: &[(&str, &str)], body: &str) -> Answer {
        let mut stream = TcpStream::connect(&self.host).expect("the server listens");
        stream.set_read_timeout(Some(PATIENCE)).expect("a limit");
        let mut text = format!("{line} HTTP/1.1\r\nConnection: close\r\n");
        for (name, value) in headers {
            text += &format!("{name}: {value}\r\n");
        }
        if !body.is_empty() {
            text += &format!("Content-Length: {}\r\n", body.len());
        }
        stream
            .write_all(format!("{text}\r\n").as_bytes())
            .expect("a request");
        // The server may have refused already and hung up.
        let _ = stream.write_all(body.as_bytes());
        let mut answer = Vec::new();
        let _ = stream.read_to_end(&mut answer);
        let answer = String::from_utf8_lossy(&answer).into_owned();
        let (head, body) = answer.split_once("\r\n\r\n").expect("a head");
        let status = head.split(' ').nth(1).and_then(|code| code.parse().ok());
        Answer {
            status: status.expect("a status"),
            head: head.to_owned(),
            body: body.to_owned(),
        }
    }

    /// Asks for a path of the page.
    #[must_use]
    pub fn get(&self, path: &str) -> Answer {
        let line = format!("GET {}{path}", self.path);
        self.request(&line, &[("Host", &self.host)], "")
    }

    /// Posts JSON to a path of the page.
    #[must_use]
    pub fn post(&self, path: &str, body: &Value) -> Answer {
        let line = format!("POST {}{path}", self.path);
        let headers = [
            ("Host", self.host.as_str()),
            ("Content-Type", "application/json"),
        ];
        self.request(&line, &headers, &body.to_string())
    }

    /// Posts the bytes of a file to a path of the page.
    #[must_use]
    pub fn send(&self, path: &str, text: &str) -> Answer {
        let line = format!("POST {}{path}", self.path);
        self.request(&line, &[("Host", &self.host)], text)
    }

    /// Begins a session; its id.
    ///
    /// # Panics
    /// If the campaign is wrong.
    #[must_use]
    pub fn begin(&self) -> String {
        let answer = self.post("api/begin", &serde_json::json!({}));
        let id = answer.json()["session"].as_str().map(str::to_owned);
        id.unwrap_or_else(|| panic!("no session: {}", answer.body))
    }

    /// The state of a session when nothing runs for it any more.
    ///
    /// # Panics
    /// If that takes too long.
    #[must_use]
    pub fn settled(&self, session: &str) -> Value {
        for _ in 0..PATIENCE.as_secs() * 10 {
            let state = self.get(&format!("api/state?session={session}")).json();
            if state["job"].is_null() {
                return state;
            }
            std::thread::sleep(Duration::from_millis(100));
        }
        panic!("the computation does not end");
    }

    /// Id of the program's process.
    #[must_use]
    pub fn process(&self) -> u32 {
        self.program.id()
    }

    /// Waits until the program has ended; its exit code.
    ///
    /// # Panics
    /// If it cannot be waited for.
    pub fn wait(&mut self) -> Option<i32> {
        self.program.wait().expect("it ends").code()
    }
}

impl Drop for PageServer {
    fn drop(&mut self) {
        let _ = self.program.kill();
        let _ = self.program.wait();
    }
}
