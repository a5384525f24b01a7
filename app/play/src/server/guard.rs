//! Access control: a request needs the token, the origin of this server, and a host name of this machine.
//!
//! Pages of other sites in the same browser can send requests to any address. They do not know the token, they have another
//! `Origin`, and after DNS rebinding they have another `Host`. Each of the three is checked.

use std::net::IpAddr;
use std::sync::Arc;

use axum::extract::{Request, State};
use axum::http::{HeaderMap, HeaderName, HeaderValue, StatusCode, header};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};

/// Names of this machine.
const LOOPBACK: [&str; 3] = ["localhost", "127.0.0.1", "[::1]"];
/// All content is from this server, and other sites cannot embed it in a frame.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; connect-src 'self'; \
                      base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// The token and the host names that a request must have.
#[derive(Debug)]
pub(super) struct Guard {
    token: String,
    /// Allowed host names.
    names: Vec<String>,
}

impl Guard {
    /// A guard with a new token for a server at an address.
    pub fn new(address: IpAddr) -> Result<Guard, getrandom::Error> {
        let mut bytes = [0_u8; 16];
        getrandom::fill(&mut bytes)?;
        let token = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
        let own = if address.is_ipv6() { format!("[{address}]") } else { address.to_string() };
        let names = LOOPBACK.iter().map(|name| (*name).to_owned()).chain([own]).collect();
        Ok(Guard { token, names })
    }

    pub fn token(&self) -> &str {
        &self.token
    }

    /// Whether a host, with any port, is a name of this server.
    fn knows(&self, host: &str) -> bool {
        let name = match host.rsplit_once(':') {
            Some((name, port)) if port.chars().all(|digit| digit.is_ascii_digit()) => name,
            _ => host,
        };
        self.names.iter().any(|known| known.eq_ignore_ascii_case(name))
    }

    /// The status of a refused request.
    fn refusal(&self, headers: &HeaderMap, path: &str) -> Option<StatusCode> {
        let text = |name: HeaderName| headers.get(name).map(|value| value.to_str().unwrap_or_default());
        if !text(header::HOST).is_some_and(|host| self.knows(host)) {
            return Some(StatusCode::FORBIDDEN);
        }
        let of_own_page = |origin: &str| origin.strip_prefix("http://").is_some_and(|host| self.knows(host));
        if text(header::ORIGIN).is_some_and(|origin| !of_own_page(origin)) {
            return Some(StatusCode::FORBIDDEN);
        }
        // A browser always sends the origin of a socket.
        let is_socket = path.ends_with("/socket");
        (is_socket && text(header::ORIGIN).is_none()).then_some(StatusCode::FORBIDDEN)
    }
}

pub(super) async fn check(State(guard): State<Arc<Guard>>, request: Request, next: Next) -> Response {
    let mut response = match guard.refusal(request.headers(), request.uri().path()) {
        Some(status) => (status, "this server serves its own page only").into_response(),
        None => next.run(request).await,
    };
    let headers = response.headers_mut();
    for (name, value) in [
        (header::CONTENT_SECURITY_POLICY, POLICY),
        (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
        (header::REFERRER_POLICY, "no-referrer"),
        (header::CACHE_CONTROL, "no-store"),
    ] {
        headers.insert(name, HeaderValue::from_static(value));
    }
    response
}

#[cfg(test)]
mod tests {
    use std::net::Ipv4Addr;

    use super::*;

    fn refusal(host: &str, origin: Option<&str>, path: &str) -> Option<StatusCode> {
        let guard = Guard::new(Ipv4Addr::LOCALHOST.into()).expect("random numbers");
        let mut headers = HeaderMap::new();
        headers.insert(header::HOST, host.parse().expect("a host"));
        if let Some(origin) = origin {
            headers.insert(header::ORIGIN, origin.parse().expect("an origin"));
        }
        guard.refusal(&headers, path)
    }

    #[test]
    fn other_origins_and_names_are_refused() {
        for host in ["127.0.0.1:1234", "localhost:8080", "localhost", "[::1]:7"] {
            assert_eq!(refusal(host, Some(&format!("http://{host}")), "/t/socket"), None, "{host}");
            assert_eq!(refusal(host, None, "/t/"), None, "{host}");
        }
        for host in ["evil.example", "127.0.0.1.evil.example:80", "localhost.evil:1", "192.168.0.7:80"] {
            assert_eq!(refusal(host, None, "/t/"), Some(StatusCode::FORBIDDEN), "{host}");
        }
        for origin in ["http://evil.example", "https://localhost", "null", "http://127.0.0.1.evil:1"] {
            assert_eq!(refusal("localhost:1", Some(origin), "/t/socket"), Some(StatusCode::FORBIDDEN), "{origin}");
        }
        assert_eq!(refusal("localhost:1", None, "/t/socket"), Some(StatusCode::FORBIDDEN));
    }

    #[test]
    fn tokens_are_long_and_differ() {
        let token = || Guard::new(Ipv4Addr::LOCALHOST.into()).expect("random numbers").token().to_owned();
        assert_eq!(token().len(), 32);
        assert_ne!(token(), token());
    }
}
