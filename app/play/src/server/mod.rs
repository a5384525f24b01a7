//! The server: one page on the loopback address, and sockets between pages and a session.

mod game;
mod guard;
mod options;
mod pages;
mod pictures;
mod playing;
mod request;

pub use options::ServeOptions;

use std::net::SocketAddr;
use std::sync::Arc;

use axum::Router;
use axum::extract::ws::{Message, WebSocket, WebSocketUpgrade};
use axum::extract::{Query, State};
use axum::http::StatusCode;
use axum::middleware;
use axum::response::{IntoResponse, Response};
use axum::routing::get;
use serde::Deserialize;
use thiserror::Error;
use tokio::net::TcpListener;
use tokio::sync::mpsc;

use self::game::Game;
use self::guard::Guard;
use self::request::Request;
use crate::study::Study;

/// Messages of pages are longer than this only by mistake or malice \[bytes\].
const MOST_BYTES: usize = 4096;
/// Messages that wait for a slow page. A page that reads none for so long is closed.
const MOST_WAITING: usize = 256;

/// Why nothing is served.
#[derive(Debug, Error)]
pub enum ServeError {
    /// The address cannot be taken.
    #[error("cannot listen on {address}: {reason}; `--port 0` takes a free port")]
    Listen {
        /// The address.
        address: SocketAddr,
        /// The reason.
        reason: std::io::Error,
    },
    /// The system gives no threads, sockets or random numbers.
    #[error("the server cannot be started: {0}")]
    Start(String),
}

/// Ends a server from another thread.
#[derive(Clone, Debug, Default)]
pub struct StopPlay(Arc<tokio::sync::Notify>);

impl StopPlay {
    /// The server ends; what is being played is kept.
    pub fn stop(&self) {
        self.0.notify_one();
    }
}

/// A server that has an address and waits for a page.
pub struct PlayServer {
    stop: StopPlay,
    runtime: tokio::runtime::Runtime,
    listener: TcpListener,
    guard: Guard,
    options: ServeOptions,
    study: Option<Study>,
}

/// What every request is served with.
#[derive(Clone)]
struct Served {
    guard: Arc<Guard>,
    requests: std::sync::mpsc::Sender<Request>,
}

impl PlayServer {
    /// Takes the address.
    ///
    /// # Errors
    /// [`ServeError`] if that is not possible.
    pub fn bind(options: ServeOptions) -> Result<PlayServer, ServeError> {
        let start = |error: &dyn std::fmt::Display| ServeError::Start(error.to_string());
        let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build();
        let runtime = runtime.map_err(|error| start(&error))?;
        let address = SocketAddr::new(options.address, options.port);
        let listener = runtime.block_on(TcpListener::bind(address));
        let listener = listener.map_err(|reason| ServeError::Listen { address, reason })?;
        let guard = Guard::new(options.address).map_err(|error| start(&error))?;
        Ok(PlayServer { stop: StopPlay::default(), runtime, listener, guard, options, study: None })
    }

    /// The same server, which walks people through a study instead of showing them a menu.
    #[must_use]
    pub fn with_study(self, study: Study) -> PlayServer {
        PlayServer { study: Some(study), ..self }
    }

    /// The address of the page.
    pub fn url(&self) -> String {
        let port = self.listener.local_addr().map_or(self.options.port, |address| address.port());
        format!("http://{}/{}/", SocketAddr::new(self.options.address, port), self.guard.token())
    }

    /// What ends it.
    pub fn stop_handle(&self) -> StopPlay {
        self.stop.clone()
    }

    /// Serves until Ctrl-C, or until it is stopped.
    ///
    /// # Errors
    /// [`ServeError::Start`] if the server breaks down.
    pub fn run(self) -> Result<(), ServeError> {
        let PlayServer { stop, runtime, listener, guard, options, study } = self;
        let (requests, received) = std::sync::mpsc::channel();
        let animation = format!("/{}/animation.webp", guard.token());
        let game = Game::new(options, study, animation, (received, requests.clone()));
        let thread = std::thread::Builder::new().name("play".to_owned()).spawn(move || game.run());
        let thread = thread.map_err(|error| ServeError::Start(error.to_string()))?;
        let served = Served { guard: Arc::new(guard), requests: requests.clone() };
        let app = routes(served);
        let ended = runtime.block_on(async move {
            tokio::select! {
                served = axum::serve(listener, app) => served.map_err(|error| ServeError::Start(error.to_string())),
                _ = tokio::signal::ctrl_c() => Ok(()),
                () = stop.0.notified() => Ok(()),
            }
        });
        // The game keeps what was played.
        let _ = requests.send(Request::Stop);
        let _ = thread.join();
        ended
    }
}

fn routes(served: Served) -> Router {
    let token = served.guard.token().to_owned();
    Router::new()
        .route(&format!("/{token}/"), get(pages::index))
        .route(&format!("/{token}/socket"), get(socket))
        .route(&format!("/{token}/pictures/{{file}}"), get(pictures::picture))
        .route(&format!("/{token}/animation.webp"), get(animation))
        .route(&format!("/{token}/{{file}}"), get(pages::file))
        .fallback(|| async { (StatusCode::NOT_FOUND, "not found") })
        .layer(middleware::from_fn_with_state(Arc::clone(&served.guard), guard::check))
        .with_state(served)
}

/// The seat of a page, if its address names one.
#[derive(Deserialize)]
struct SocketQuery {
    seat: Option<String>,
}

async fn socket(State(served): State<Served>, Query(query): Query<SocketQuery>, upgrade: WebSocketUpgrade) -> Response {
    let upgrade = upgrade.max_message_size(MOST_BYTES).max_frame_size(MOST_BYTES);
    upgrade.on_upgrade(move |socket| talk(socket, served, query.seat))
}

/// Carries messages between a page and the game until either is gone.
async fn talk(mut socket: WebSocket, served: Served, seat: Option<String>) {
    let (outgoing, mut waiting) = mpsc::channel(MOST_WAITING);
    let (number, mut confirmed) = tokio::sync::oneshot::channel();
    if served.requests.send(Request::Join { seat, outgoing, number }).is_err() {
        return;
    }
    let Ok(page) = (&mut confirmed).await else { return };
    loop {
        tokio::select! {
            said = waiting.recv() => match said {
                Some(text) => {
                    if socket.send(Message::Text(text.into())).await.is_err() {
                        break;
                    }
                }
                None => break,
            },
            heard = socket.recv() => match heard {
                Some(Ok(Message::Text(text))) => {
                    if served.requests.send(Request::Said { page, text: text.to_string() }).is_err() {
                        break;
                    }
                }
                Some(Ok(Message::Ping(_) | Message::Pong(_))) => {}
                // Bytes are no message of ours; whoever sends them is no page of ours.
                Some(Ok(Message::Binary(_) | Message::Close(_)) | Err(_)) | None => break,
            },
        }
    }
    let _ = served.requests.send(Request::Leave { page });
}

async fn animation(State(served): State<Served>) -> Response {
    let (answer, answered) = tokio::sync::oneshot::channel();
    let _ = served.requests.send(Request::Animation { answer });
    match answered.await {
        Ok(Some(scenarios)) => {
            let drawn = tokio::task::spawn_blocking(move || pictures::animation(scenarios)).await;
            drawn.ok().flatten().map_or_else(|| StatusCode::NOT_FOUND.into_response(), pages::image)
        }
        _ => StatusCode::NOT_FOUND.into_response(),
    }
}
