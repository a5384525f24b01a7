//! The server: one page on the loopback address, and sockets between pages and a session.

mod game;
mod guard;
mod pages;
mod playing;
mod request;

use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use std::path::PathBuf;
use std::sync::Arc;

use axum::Router;
use axum::extract::ws::{Message, WebSocket, WebSocketUpgrade};
use axum::extract::{Query, State};
use axum::http::StatusCode;
use axum::middleware;
use axum::response::{IntoResponse, Response};
use axum::routing::get;
use interplay_scenarios::Registry;
use serde::Deserialize;
use thiserror::Error;
use tokio::net::TcpListener;
use tokio::sync::mpsc;

use self::game::Game;
use self::guard::Guard;
use self::request::Request;
use crate::study::Study;

/// Longest message of a page \[bytes\].
const MAX_MESSAGE_BYTES: usize = 4096;
/// Most queued messages for a slow page. When the queue is full, the page is closed.
const MAX_QUEUED: usize = 256;

/// Options of the server.
#[derive(Clone, Debug)]
pub struct ServeOptions {
    /// The address; by default that of this machine alone.
    pub address: IpAddr,
    /// The port; 0 takes a free one.
    pub port: u16,
    /// The first scenario and its seat; `None` for the menu.
    pub chosen: Option<(String, String)>,
    /// A second seat, for a second page.
    pub joined: Option<String>,
    /// The folder of saved runs.
    pub folder: PathBuf,
    /// The kinds of drivers and metrics.
    pub registry: Registry,
}

impl ServeOptions {
    /// A server for this machine alone, on a free port.
    pub fn new(registry: &Registry) -> ServeOptions {
        ServeOptions {
            address: Ipv4Addr::LOCALHOST.into(),
            port: 0,
            chosen: None,
            joined: None,
            folder: PathBuf::from("played"),
            registry: registry.clone(),
        }
    }
}

/// Why the server failed.
#[derive(Debug, Error)]
pub enum ServeError {
    /// The address is not available.
    #[error("cannot listen on {address}: {reason}; `--port 0` takes a free port")]
    Listen {
        /// The address.
        address: SocketAddr,
        /// The reason.
        reason: std::io::Error,
    },
    /// The system refuses threads, sockets or random numbers.
    #[error("the server cannot be started: {0}")]
    Start(String),
}

/// Ends a server from another thread.
#[derive(Clone, Debug, Default)]
pub struct StopPlay(Arc<tokio::sync::Notify>);

impl StopPlay {
    /// Ends the server, which saves the played run.
    pub fn stop(&self) {
        self.0.notify_one();
    }
}

/// A server with an address, before it serves pages.
pub struct PlayServer {
    stop: StopPlay,
    runtime: tokio::runtime::Runtime,
    listener: TcpListener,
    guard: Guard,
    options: ServeOptions,
    study: Option<Study>,
}

/// The state of the request handlers.
#[derive(Clone)]
struct Served {
    guard: Arc<Guard>,
    requests: std::sync::mpsc::Sender<Request>,
}

impl PlayServer {
    /// Binds the address.
    ///
    /// # Errors
    /// [`ServeError`] if the address is not available or the system refuses resources.
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

    /// The server with a study instead of the menu.
    #[must_use]
    pub fn with_study(self, study: Study) -> PlayServer {
        PlayServer { study: Some(study), ..self }
    }

    /// The address of the page.
    pub fn url(&self) -> String {
        let port = self.listener.local_addr().map_or(self.options.port, |address| address.port());
        format!("http://{}/{}/", SocketAddr::new(self.options.address, port), self.guard.token())
    }

    /// A handle that ends the server.
    pub fn stop_handle(&self) -> StopPlay {
        self.stop.clone()
    }

    /// Serves until Ctrl-C, or until it is stopped.
    ///
    /// # Errors
    /// [`ServeError::Start`] if the server fails.
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
        // The game saves the played run.
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
        .route(&format!("/{token}/pictures/{{file}}"), get(pages::family_picture))
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
    let upgrade = upgrade.max_message_size(MAX_MESSAGE_BYTES).max_frame_size(MAX_MESSAGE_BYTES);
    upgrade.on_upgrade(move |socket| relay(socket, served, query.seat))
}

/// Passes messages between a page and the game until either is gone.
async fn relay(mut socket: WebSocket, served: Served, seat: Option<String>) {
    let (outgoing, mut waiting) = mpsc::channel(MAX_QUEUED);
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
                // Pages never send binary messages, so the sender is not a page of this server.
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
            let drawn = tokio::task::spawn_blocking(move || pages::animation(scenarios)).await;
            drawn.ok().flatten().map_or_else(|| StatusCode::NOT_FOUND.into_response(), pages::image)
        }
        _ => StatusCode::NOT_FOUND.into_response(),
    }
}
