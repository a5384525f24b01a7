//! A server in a thread, and its pages.

use std::io::{Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::path::Path;
use std::thread::JoinHandle;
use std::time::Duration;

use interplay_play::{PlayServer, ServeError, ServeOptions, StopPlay};
use interplay_scenarios::Registry;
use serde_json::{Value as Json, json};
use tungstenite::client::IntoClientRequest;
use tungstenite::{Message, WebSocket, client};

/// A server in a thread of its own.
pub struct Served {
    pub address: SocketAddr,
    url: String,
    stop: StopPlay,
    thread: JoinHandle<Result<(), ServeError>>,
}

impl Served {
    pub fn start(folder: &Path) -> Served {
        let chosen = Some(("lane-change/front-nice".to_owned(), "ego".to_owned()));
        let folder = folder.to_owned();
        let options =
            ServeOptions { chosen, folder, joined: Some("rear".to_owned()), ..ServeOptions::new(Registry::standard()) };
        Served::of(PlayServer::bind(options).expect("a free port"))
    }

    pub fn of(server: PlayServer) -> Served {
        let (url, stop) = (server.url(), server.stop_handle());
        let address = url.trim_start_matches("http://").split('/').next().and_then(|host| host.parse().ok());
        Served { address: address.expect("an address"), url, stop, thread: std::thread::spawn(move || server.run()) }
    }

    pub fn token(&self) -> &str {
        self.url.trim_end_matches('/').rsplit('/').next().expect("a token")
    }

    pub fn status(&self, path: &str, headers: &str) -> u16 {
        let mut stream = TcpStream::connect(self.address).expect("the server listens");
        write!(stream, "GET {path} HTTP/1.1\r\n{headers}Connection: close\r\n\r\n").expect("the server reads");
        let mut text = String::new();
        stream.read_to_string(&mut text).expect("an answer");
        text.split_whitespace().nth(1).and_then(|status| status.parse().ok()).unwrap_or_default()
    }

    pub fn page(&self, query: &str, origin: &str) -> Option<Page> {
        let url = format!("ws://{}/{}/socket{query}", self.address, self.token());
        let mut request = url.into_client_request().expect("a request");
        request.headers_mut().insert("Origin", origin.parse().expect("an origin"));
        let stream = TcpStream::connect(self.address).expect("the server listens");
        stream.set_read_timeout(Some(Duration::from_secs(20))).expect("a time");
        client(request, stream).ok().map(|(socket, _)| Page(socket))
    }

    pub fn own_page(&self) -> Page {
        self.page("", &format!("http://{}", self.address)).expect("the own page is served")
    }

    pub fn end(self) {
        self.stop.stop();
        self.thread.join().expect("no panic").expect("the server ends without error");
    }
}

pub struct Page(pub WebSocket<TcpStream>);

impl Page {
    pub fn say(&mut self, message: &Json) {
        self.0.send(Message::text(message.to_string())).expect("the server reads");
    }

    /// The next message of a type.
    pub fn hear(&mut self, kind: &str) -> Json {
        loop {
            let Message::Text(text) = self.0.read().expect("a message") else { continue };
            let json: Json = serde_json::from_str(&text).expect("messages are JSON");
            if json["type"] == kind {
                return json;
            }
        }
    }

    pub fn drive(&mut self) {
        self.say(&json!({ "type": "input", "seq": 1, "acceleration": 0.4, "steering": 0.2, "assist": true }));
    }
}
