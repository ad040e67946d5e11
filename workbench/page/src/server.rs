//! The server: bound to 127.0.0.1, stopped with Ctrl-C.
use std::net::{Ipv4Addr, SocketAddr};
use std::sync::Arc;

use axum::Router;
use axum::extract::DefaultBodyLimit;
use axum::middleware;
use tokio::net::TcpListener;
use tokio::runtime::Runtime;

use super::guard::{self, Guard, random_token};
use super::live::LoopSource;
use super::routes;
use super::sessions::Sessions;
use super::source::Source;
use hitch_output::error::Error;

/// Maximum size of a request, bytes; the requests of the page are short.
const LARGEST_REQUEST: usize = 64 * 1024;

/// Serves the page until Ctrl-C.
///
/// # Errors
/// If the port cannot be used, or the address cannot be printed.
pub fn run(
    source: Source,
    loop_source: LoopSource,
    port: u16,
    open_browser: bool,
) -> Result<(), Error> {
    let runtime = Runtime::new().map_err(cannot_start)?;
    let sessions = Arc::new(Sessions::new(source, loop_source));
    let page = runtime.block_on(start(Arc::clone(&sessions), port))?;
    hitch_output::print(&format!("{page}\nStop it with Ctrl-C.\n"))?;
    if open_browser && let Err(error) = open::that_detached(&page) {
        eprintln!("hitch: the browser could not be opened ({error}); open the address above");
    }
    // Reads the campaign in advance, so that the first page loads faster.
    let early = Arc::clone(&sessions);
    runtime.spawn_blocking(move || match early.subject() {
        Ok(_) => {}
        Err(error) => eprintln!("hitch: {error}"),
    });
    let stopped = runtime.block_on(stopped());
    // Running computations and open pages do not delay the exit.
    runtime.shutdown_background();
    sessions.loop_source.close();
    sessions.folders.close();
    stopped.map_err(cannot_start)
}

/// Waits until the server is to stop: Ctrl-C, or the signal to terminate.
async fn stopped() -> std::io::Result<()> {
    let (send, mut receive) = tokio::sync::mpsc::channel(1);
    #[cfg(unix)]
    {
        use tokio::signal::unix::{SignalKind, signal};
        let mut terminated = signal(SignalKind::terminate())?;
        let send = send.clone();
        tokio::spawn(async move {
            terminated.recv().await;
            send.send(Ok(())).await
        });
    }
    tokio::spawn(async move { send.send(tokio::signal::ctrl_c().await).await });
    receive.recv().await.unwrap_or(Ok(()))
}

/// Starts the server in the background of the current runtime; returns the address of the page.
///
/// # Errors
/// If the port is not available.
async fn start(sessions: Arc<Sessions>, port: u16) -> Result<String, Error> {
    let wanted = SocketAddr::from((Ipv4Addr::LOCALHOST, port));
    let cannot_listen = |error| {
        Error::Usage(format!(
            "port {port} is not available: {error}; give another one, or omit --port"
        ))
    };
    let listener = TcpListener::bind(wanted).await.map_err(cannot_listen)?;
    let port = listener.local_addr().map_err(cannot_listen)?.port();
    let token = random_token();
    let page = format!("http://127.0.0.1:{port}/{token}/");
    let app = app(sessions, Guard::new(token, port));
    tokio::spawn(async move { axum::serve(listener, app).await });
    Ok(page)
}

fn app(sessions: Arc<Sessions>, guard: Guard) -> Router {
    routes::routes()
        .layer(DefaultBodyLimit::max(LARGEST_REQUEST))
        .layer(middleware::from_fn_with_state(guard, guard::check))
        .with_state(sessions)
}

fn cannot_start(error: std::io::Error) -> Error {
    Error::Failed(format!("the server cannot run: {error}"))
}
