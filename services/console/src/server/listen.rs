//! The search for a port: first that of the console's previous incarnation, so that pages find it
//! again, then the configured one and those after it.

use std::io;
use std::net::{SocketAddr, TcpListener};
use std::path::Path;

/// Ports that are tried from the configured one on.
const PORTS: u16 = 16;

/// Binds the first free one of these ports.
///
/// # Errors
/// The address is not this machine's, or every port is taken.
pub fn bind(configured: SocketAddr, predecessor: Option<SocketAddr>) -> io::Result<TcpListener> {
    let before = predecessor.filter(|before| before.ip() == configured.ip());
    if let Some(listener) = before.and_then(|before| bound(before).ok()) {
        return Ok(listener);
    }
    let first = bound(configured);
    if configured.port() == 0 || first.is_ok() {
        return first;
    }
    let next = (1..PORTS).filter_map(|n| configured.port().checked_add(n));
    let mut next = next.map(|port| SocketAddr::new(configured.ip(), port));
    next.find_map(|address| bound(address).ok()).map_or(first, Ok)
}

fn bound(address: SocketAddr) -> io::Result<TcpListener> {
    let listener = TcpListener::bind(address)?;
    listener.set_nonblocking(true)?;
    Ok(listener)
}

/// Returns the URL for a browser on this machine.
pub fn url(address: SocketAddr) -> String {
    match address.ip().is_unspecified() {
        true => format!("http://localhost:{}/", address.port()),
        false => format!("http://{address}/"),
    }
}

/// Reads the address of the previous incarnation.
pub fn predecessor(file: &Path, configured: SocketAddr) -> Option<SocketAddr> {
    let text = std::fs::read_to_string(file).ok()?;
    let place = text.trim().strip_prefix("http://")?.strip_suffix('/')?;
    let port = place.rsplit_once(':')?.1.parse().ok()?;
    Some(SocketAddr::new(configured.ip(), port))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn any() -> SocketAddr {
        "127.0.0.1:0".parse().unwrap()
    }

    #[test]
    fn listen_takes_the_next_free_port() {
        let taken = bind(any(), None).unwrap();
        let address = taken.local_addr().unwrap();
        let next = bind(address, None).unwrap().local_addr().unwrap();
        assert!((1..PORTS).contains(&(next.port() - address.port())), "{address} {next}");
    }

    #[test]
    fn listen_prefers_the_previous_port() {
        let first = bind(any(), None).unwrap();
        let before = first.local_addr().unwrap();
        drop(first);
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("console.url");
        assert_eq!(predecessor(&file, any()), None);
        std::fs::write(&file, url(before)).unwrap();
        assert_eq!(predecessor(&file, any()), Some(before));
        let again = bind(any(), predecessor(&file, any())).unwrap();
        assert_eq!(again.local_addr().unwrap(), before);
        assert_ne!(bind(any(), Some(before)).unwrap().local_addr().unwrap(), before);
    }

    #[test]
    fn listen_shows_an_unspecified_address_as_localhost() {
        assert_eq!(url("0.0.0.0:80".parse().unwrap()), "http://localhost:80/");
        assert_eq!(url("[::1]:8377".parse().unwrap()), "http://[::1]:8377/");
    }
}
