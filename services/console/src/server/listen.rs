//! Finding a port. A page finds its console again at the port that it had, so a console that is
//! started anew first tries its predecessor's; after that the configured one and those behind it.

use std::io;
use std::net::{SocketAddr, TcpListener};
use std::path::Path;

/// Ports that are tried from the configured one on.
const PORTS: u16 = 16;

/// Binds the first free one of the ports to be tried.
///
/// # Errors
/// The address is not this machine's, or every port is taken: the configured one's trouble.
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

/// The address at which pages are opened in this machine's browser.
pub fn url(address: SocketAddr) -> String {
    match address.ip().is_unspecified() {
        true => format!("http://localhost:{}/", address.port()),
        false => format!("http://{address}/"),
    }
}

/// The address of the console before this one, as it left it.
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
    fn a_taken_port_makes_room_for_the_next() {
        let taken = bind(any(), None).unwrap();
        let address = taken.local_addr().unwrap();
        let next = bind(address, None).unwrap().local_addr().unwrap();
        assert!((1..PORTS).contains(&(next.port() - address.port())), "{address} {next}");
    }

    #[test]
    fn the_predecessors_port_comes_first() {
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
    fn an_open_address_is_shown_as_this_machine() {
        assert_eq!(url("0.0.0.0:80".parse().unwrap()), "http://localhost:80/");
        assert_eq!(url("[::1]:8377".parse().unwrap()), "http://[::1]:8377/");
    }
}
