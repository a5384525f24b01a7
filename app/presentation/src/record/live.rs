//! The viewer to which a live recording is streamed.

use std::fmt;
use std::net::{TcpStream, ToSocketAddrs};
use std::str::FromStr;
use std::time::Duration;

use rerun::external::re_uri::ProxyUri;

use super::open_recording::{RecordError, ViewerAddressError};

/// Timeout for the connection to a viewer.
const CONNECT_TIMEOUT: Duration = Duration::from_secs(2);

/// The address of a Rerun viewer, such as `rerun+http://127.0.0.1:9876/proxy`, the default address of a
/// viewer on this machine.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Viewer(ProxyUri);

impl Viewer {
    /// A viewer on this machine that was started as `rerun`.
    ///
    /// # Errors
    /// Only if Rerun cannot parse its own default address.
    pub fn here() -> Result<Viewer, ViewerAddressError> {
        rerun::DEFAULT_CONNECT_URL.parse()
    }

    /// Checks that a viewer listens at the address.
    pub(super) fn check_reachable(&self) -> Result<(), RecordError> {
        let origin = &self.0.origin;
        let address = (origin.host.to_string().trim_matches(['[', ']']).to_owned(), origin.port);
        let reached = address.to_socket_addrs().and_then(|mut found| {
            let first = found.next().ok_or(std::io::ErrorKind::NotFound)?;
            TcpStream::connect_timeout(&first, CONNECT_TIMEOUT)
        });
        let refuse = |reason: std::io::Error| RecordError::NoViewer {
            address: format!("{}:{}", origin.host, origin.port),
            reason,
        };
        reached.map(drop).map_err(refuse)
    }
}

impl fmt::Display for Viewer {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(formatter)
    }
}

impl FromStr for Viewer {
    type Err = ViewerAddressError;

    fn from_str(text: &str) -> Result<Viewer, ViewerAddressError> {
        text.parse().map(Viewer).map_err(|_| ViewerAddressError)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn viewer_addresses_round_trip_and_other_texts_are_refused() {
        let here = Viewer::here().expect("Rerun's own");
        assert_eq!(here.to_string(), "rerun+http://127.0.0.1:9876/proxy");
        assert_eq!(here.to_string().parse(), Ok(here));
        for wrong in ["", "nowhere", "http://127.0.0.1:9876", "rerun+http://127.0.0.1:9876/catalog"] {
            let error = wrong.parse::<Viewer>().expect_err(wrong).to_string();
            assert!(error.contains("rerun+http://127.0.0.1:9876/proxy"), "{error}");
        }
    }

    #[test]
    fn a_closed_viewer_is_an_error_that_names_its_address() {
        let listener = std::net::TcpListener::bind("127.0.0.1:0").expect("a free port");
        let port = listener.local_addr().expect("bound").port();
        let viewer: Viewer = format!("rerun+http://127.0.0.1:{port}/proxy").parse().expect("an address");
        viewer.check_reachable().expect("the viewer listens");
        drop(listener);
        let error = viewer.check_reachable().expect_err("the viewer is closed").to_string();
        assert!(error.contains(&format!("127.0.0.1:{port}")) && error.contains("--connect"), "{error}");
    }
}
