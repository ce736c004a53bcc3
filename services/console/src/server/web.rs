//! The web server's life: its threads, its port, and the file with its address.
//!
//! Ports are tried in this order: that of the console's previous incarnation, so that pages find it
//! again, the configured one, and those after it.

use std::io;
use std::net::{SocketAddr, TcpListener};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use service::{Span, Time};
use tokio::runtime::Runtime;
use web_server::connections::{Gate, Pages};

use super::{App, serve};

/// Ports that are tried from the configured one on.
const PORTS: u16 = 16;
const WORKERS: usize = 2;
/// Longest standstill of the web server's tasks.
const STANDSTILL: Span = Span::from_ms(2_000);
/// Interval between attempts to bind while every port is taken.
const BIND_EVERY: Span = Span::from_ms(2_000);
/// Grace period for pages to close their sockets.
const CLOSE: Duration = Duration::from_secs(2);

#[derive(Debug)]
pub struct Web {
    /// None once the server was shut down.
    runtime: Option<Runtime>,
    app: Arc<App>,
    configured: SocketAddr,
    url_file: PathBuf,
    /// Most connections other than pages.
    others_max: usize,
    listening: bool,
    tried: Option<Time>,
    /// Progress of the server's tasks, and when it was seen last.
    progress: (u64, Time),
}

impl Web {
    /// Starts the server's threads; it listens at `configured` once there is a port, and holds at
    /// most `others_max` connections besides those of pages.
    pub fn new(
        app: &Arc<App>,
        configured: SocketAddr,
        url_file: PathBuf,
        others_max: usize,
    ) -> io::Result<Self> {
        let runtime = tokio::runtime::Builder::new_multi_thread()
            .worker_threads(WORKERS)
            .thread_name("web")
            .enable_all()
            .build()?;
        Ok(Self {
            runtime: Some(runtime),
            app: Arc::clone(app),
            configured,
            url_file,
            others_max,
            listening: false,
            tried: None,
            progress: (0, Time(0)),
        })
    }

    /// Returns whether the server's tasks make progress.
    pub fn is_working(&mut self, now: Time) -> bool {
        let progress = self.app.hub.progress.load(Ordering::Relaxed);
        if progress != self.progress.0 {
            self.progress = (progress, now);
        }
        !self.listening || now.since(self.progress.1) < STANDSTILL
    }

    pub fn try_to_listen(&mut self, now: Time) {
        if self.listening || self.tried.is_some_and(|tried| now < tried + BIND_EVERY) {
            return;
        }
        let first = self.tried.replace(now).is_none();
        let before = predecessor(&self.url_file, self.configured);
        let Some(runtime) = &self.runtime else { return };
        let _guard = runtime.enter();
        let bound = bind(self.configured, before).and_then(|listener| {
            let address = listener.local_addr()?;
            Ok((tokio::net::TcpListener::from_std(listener)?, address))
        });
        match bound {
            Ok((listener, address)) => self.begin(listener, address, now),
            Err(error) if first => {
                let wanted = self.configured;
                tracing::warn!(%wanted, %error, "no page: neither this port nor the next 15 is free");
            }
            Err(_) => {}
        }
    }

    fn begin(&mut self, listener: tokio::net::TcpListener, address: SocketAddr, now: Time) {
        let (wanted, url) = (self.configured, url_of(address));
        if wanted.port() != 0 && wanted.port() != address.port() {
            tracing::warn!(%wanted, taken = %address, "the configured port is not free; another one is used");
        }
        tracing::info!(url, "the page is served");
        if let Err(error) = safe_files::replace_private(&self.url_file, format!("{url}\n")) {
            tracing::warn!(%error, "the page's address is not written");
        }
        self.app.http.announce(address);
        let app = Arc::clone(&self.app);
        let gate = Gate::new(listener, self.others_max, Pages::Apart);
        if let Some(runtime) = &self.runtime {
            runtime.spawn(async move {
                if let Err(error) = serve(gate, app).await {
                    tracing::error!(%error, "the web server has ended");
                }
            });
        }
        (self.listening, self.progress) = (true, (0, now));
    }

    pub fn shut_down(&mut self) {
        let Some(runtime) = self.runtime.take() else { return };
        self.app.http.withdraw();
        self.app.hub.end();
        let until = Instant::now() + CLOSE;
        while self.app.hub.viewers() > 0 && Instant::now() < until {
            std::thread::sleep(Duration::from_millis(5));
        }
        runtime.shutdown_timeout(Duration::from_millis(500));
    }
}

/// Binds the first free one of these ports.
fn bind(configured: SocketAddr, predecessor: Option<SocketAddr>) -> io::Result<TcpListener> {
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
fn url_of(address: SocketAddr) -> String {
    match address.ip().is_unspecified() {
        true => format!("http://localhost:{}/", address.port()),
        false => format!("http://{address}/"),
    }
}

/// Reads the address of the previous incarnation.
fn predecessor(file: &Path, configured: SocketAddr) -> Option<SocketAddr> {
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
        std::fs::write(&file, url_of(before)).unwrap();
        assert_eq!(predecessor(&file, any()), Some(before));
        let again = bind(any(), predecessor(&file, any())).unwrap();
        assert_eq!(again.local_addr().unwrap(), before);
        assert_ne!(bind(any(), Some(before)).unwrap().local_addr().unwrap(), before);
    }

    #[test]
    fn listen_shows_an_unspecified_address_as_localhost() {
        assert_eq!(url_of("0.0.0.0:80".parse().unwrap()), "http://localhost:80/");
        assert_eq!(url_of("[::1]:8377".parse().unwrap()), "http://[::1]:8377/");
    }
}
