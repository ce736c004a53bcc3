//! The web server's life: its threads, its port, and the file with its address.

use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use service::{Span, Time};
use tokio::net::TcpListener;
use tokio::runtime::Runtime;

use super::{App, listen, serve};

/// Threads of the web server.
const WORKERS: usize = 2;
/// Longest standstill of the web server's tasks.
const STANDSTILL: Span = Span::from_ms(2_000);
/// Interval between attempts to bind while every port is taken.
const BIND_EVERY: Span = Span::from_ms(2_000);
/// Grace period for pages to close their sockets.
const CLOSE: Duration = Duration::from_secs(2);

/// The web server and its address.
#[derive(Debug)]
pub struct Web {
    /// None once the server was shut down.
    runtime: Option<Runtime>,
    app: Arc<App>,
    configured: SocketAddr,
    url_file: PathBuf,
    listening: bool,
    tried: Option<Time>,
    /// Progress of the server's tasks, and when it was seen last.
    progress: (u64, Time),
}

impl Web {
    /// Starts the server's threads; it listens at `configured` once there is a port.
    ///
    /// # Errors
    /// The operating system refuses threads.
    pub fn new(app: &Arc<App>, configured: SocketAddr, url_file: PathBuf) -> std::io::Result<Self> {
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
            listening: false,
            tried: None,
            progress: (0, Time(0)),
        })
    }

    /// Returns whether the server's tasks make progress.
    pub fn is_working(&mut self, now: Time) -> bool {
        let progress = self.app.hub.progress();
        if progress != self.progress.0 {
            self.progress = (progress, now);
        }
        !self.listening || now.since(self.progress.1) < STANDSTILL
    }

    /// Listens as soon as a port is free.
    pub fn try_to_listen(&mut self, now: Time) {
        if self.listening || self.tried.is_some_and(|tried| now < tried + BIND_EVERY) {
            return;
        }
        let first = self.tried.replace(now).is_none();
        let before = listen::predecessor(&self.url_file, self.configured);
        let Some(runtime) = &self.runtime else { return };
        let _guard = runtime.enter();
        let bound = listen::bind(self.configured, before).and_then(|listener| {
            let address = listener.local_addr()?;
            Ok((TcpListener::from_std(listener)?, address))
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

    fn begin(&mut self, listener: TcpListener, address: SocketAddr, now: Time) {
        let (wanted, url) = (self.configured, listen::url(address));
        if wanted.port() != 0 && wanted.port() != address.port() {
            tracing::warn!(%wanted, taken = %address, "the configured port is not free; another one is used");
        }
        tracing::info!(url, "the page is served");
        if let Err(error) = write_url(&self.url_file, &url) {
            tracing::warn!(%error, "the page's address is not written");
        }
        let app = Arc::clone(&self.app);
        if let Some(runtime) = &self.runtime {
            runtime.spawn(async move {
                if let Err(error) = serve(listener, app).await {
                    tracing::error!(%error, "the web server has ended");
                }
            });
        }
        (self.listening, self.progress) = (true, (0, now));
    }

    /// Closes every page's socket and ends the server.
    pub fn shut_down(&mut self) {
        let Some(runtime) = self.runtime.take() else { return };
        self.app.hub.end();
        let until = Instant::now() + CLOSE;
        while self.app.hub.viewers() > 0 && Instant::now() < until {
            std::thread::sleep(Duration::from_millis(5));
        }
        runtime.shutdown_timeout(Duration::from_millis(500));
    }
}

/// Replaces the file with the address atomically.
fn write_url(path: &Path, url: &str) -> std::io::Result<()> {
    journal::replace_file(path, format!("{url}\n"))
}
