//! The open connections: bounded in number and in the time that they may take.
//!
//! A connection proves itself by a request with a secret or a session. One that has not, gives way to
//! newer ones and ends after [`PROOF_PATIENCE`] whatever it does; a proven one ends when its client is silent. So places
//! are left for the next visitor, whatever the others do or leave undone.

use std::fmt;
use std::io;
use std::net::SocketAddr;
use std::pin::Pin;
use std::sync::atomic::{AtomicBool, AtomicU8, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::task::{Context, Poll};
use std::time::Duration;

use axum::extract::connect_info::Connected;
use axum::serve::{IncomingStream, Listener};
use futures_util::task::AtomicWaker;
use service::{Span, Time, clock};
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::net::{TcpListener, TcpStream};

/// Life of a connection without a request that proves it.
const PROOF_PATIENCE: Span = Span::from_ms(10_000);
/// Longest silence of a proven client: the bytes that it takes do not count. Pings every 20 s let an open page speak.
const SILENCE_MAX: Span = Span::from_ms(75_000);
/// Pause where no descriptor or no place is left.
const PAUSE: Duration = Duration::from_millis(20);

/// The places that the sockets of pages take.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pages {
    /// None: their server counts them, and ends silent ones itself.
    Apart,
    /// One each, as other connections do, and their silence ends them. New connections wait while all are pages.
    Among,
}

/// The stage of a connection.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stage {
    Unproven,
    Proven,
    Page,
}

/// One open connection.
#[derive(Debug)]
pub struct Connection {
    began: Time,
    /// When the client sent bytes last, nanoseconds.
    active: AtomicU64,
    stage: AtomicU8,
    is_closed: AtomicBool,
    waker: AtomicWaker,
}

impl Connection {
    fn new(now: Time) -> Self {
        Self {
            began: now,
            active: AtomicU64::new(now.ns()),
            stage: AtomicU8::new(Stage::Unproven as u8),
            is_closed: AtomicBool::new(false),
            waker: AtomicWaker::new(),
        }
    }

    /// Notes a request with a secret or a session.
    pub fn prove(&self) {
        self.stage.fetch_max(Stage::Proven as u8, Ordering::Relaxed);
    }

    /// Notes that it has become a page's socket.
    pub fn become_page(&self) {
        self.stage.store(Stage::Page as u8, Ordering::Relaxed);
    }

    fn is(&self, stage: Stage) -> bool {
        self.stage.load(Ordering::Relaxed) == stage as u8
    }

    fn is_expired(&self, now: Time, pages: Pages) -> bool {
        if self.is(Stage::Unproven) {
            return now.since(self.began) >= PROOF_PATIENCE;
        }
        let active = Time(self.active.load(Ordering::Relaxed));
        self.takes_place(pages) && now.since(active) >= SILENCE_MAX
    }

    fn takes_place(&self, pages: Pages) -> bool {
        pages == Pages::Among || !self.is(Stage::Page)
    }

    fn close(&self) {
        self.is_closed.store(true, Ordering::Release);
        self.waker.wake();
    }

    /// Returns the error of a closed connection; registers for its end otherwise.
    fn look(&self, cx: &mut Context<'_>) -> io::Result<()> {
        self.waker.register(cx.waker());
        match self.is_closed.load(Ordering::Acquire) {
            true => Err(io::ErrorKind::TimedOut.into()),
            false => Ok(()),
        }
    }
}

/// The table of open connections, oldest first.
#[derive(Debug)]
pub struct Connections {
    open: Mutex<Vec<Arc<Connection>>>,
    most: usize,
    pages: Pages,
}

impl Connections {
    /// Makes an empty table with places for `most` connections.
    pub fn new(most: usize, pages: Pages) -> Self {
        Self { open: Mutex::default(), most, pages }
    }

    /// Ends connections whose time is over. Returns whether there are any connections.
    pub fn tick(&self, now: Time) -> bool {
        let open = self.open();
        let expired = open.iter().filter(|open| open.is_expired(now, self.pages));
        expired.for_each(|open| open.close());
        !open.is_empty()
    }

    /// Admits a new connection; where there are too many, the oldest unproven one gives way, or else the
    /// oldest proven one. `None` while pages have all places.
    fn admit(&self, now: Time) -> Option<Arc<Connection>> {
        let mut open = self.open();
        if open.iter().filter(|open| open.takes_place(self.pages)).count() >= self.most {
            let oldest = [Stage::Unproven, Stage::Proven];
            let oldest = oldest.iter().find_map(|stage| open.iter().position(|it| it.is(*stage)));
            open.remove(oldest?).close();
        }
        let connection = Arc::new(Connection::new(now));
        open.push(Arc::clone(&connection));
        Some(connection)
    }

    async fn wait_for_place(&self) -> Arc<Connection> {
        loop {
            match self.admit(clock::now()) {
                Some(connection) => return connection,
                None => tokio::time::sleep(PAUSE).await,
            }
        }
    }

    fn remove(&self, connection: &Arc<Connection>) {
        self.open().retain(|open| !Arc::ptr_eq(open, connection));
    }

    fn open(&self) -> MutexGuard<'_, Vec<Arc<Connection>>> {
        // Every change leaves a consistent list.
        self.open.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The listener, with the table of what it has accepted.
#[derive(Debug)]
pub struct Gate {
    listener: TcpListener,
    table: Arc<Connections>,
}

impl Gate {
    /// Guards a listener.
    pub fn new(listener: TcpListener, most: usize, pages: Pages) -> Self {
        Self { listener, table: Arc::new(Connections::new(most, pages)) }
    }

    /// The open connections, which need a [`Connections::tick`] every second.
    pub fn table(&self) -> Arc<Connections> {
        Arc::clone(&self.table)
    }
}

impl Listener for Gate {
    type Io = Guarded;
    type Addr = SocketAddr;

    async fn accept(&mut self) -> (Guarded, SocketAddr) {
        loop {
            match self.listener.accept().await {
                Ok((stream, address)) => {
                    // A stop is a small packet.
                    let _ = stream.set_nodelay(true);
                    let table = Arc::clone(&self.table);
                    let connection = table.wait_for_place().await;
                    return (Guarded { stream, connection, table }, address);
                }
                Err(error) => {
                    tracing::debug!(%error, "no connection accepted");
                    tokio::time::sleep(PAUSE).await;
                }
            }
        }
    }

    fn local_addr(&self) -> io::Result<SocketAddr> {
        self.listener.local_addr()
    }
}

/// A stream that ends when its connection is closed in the table.
#[derive(Debug)]
pub struct Guarded {
    stream: TcpStream,
    connection: Arc<Connection>,
    table: Arc<Connections>,
}

impl Drop for Guarded {
    fn drop(&mut self) {
        self.table.remove(&self.connection);
    }
}

impl AsyncRead for Guarded {
    fn poll_read(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        buf: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        self.connection.look(cx)?;
        let before = buf.filled().len();
        let read = Pin::new(&mut self.stream).poll_read(cx, buf);
        if buf.filled().len() > before {
            self.connection.active.store(clock::now().ns(), Ordering::Relaxed);
        }
        read
    }
}

impl AsyncWrite for Guarded {
    fn poll_write(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        bytes: &[u8],
    ) -> Poll<io::Result<usize>> {
        self.connection.look(cx)?;
        Pin::new(&mut self.stream).poll_write(cx, bytes)
    }

    fn poll_flush(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        self.connection.look(cx)?;
        Pin::new(&mut self.stream).poll_flush(cx)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_shutdown(cx)
    }
}

/// The connection of a request.
#[derive(Clone)]
pub struct Of(pub Arc<Connection>);

impl fmt::Debug for Of {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl Connected<IncomingStream<'_, Gate>> for Of {
    fn connect_info(stream: IncomingStream<'_, Gate>) -> Self {
        Self(Arc::clone(&stream.io().connection))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(ms: u64) -> Time {
        Time(1_000_000 * ms)
    }

    #[test]
    fn unproven_connections_give_way_first() {
        let table = Connections::new(3, Pages::Apart);
        let admit = |ms| table.admit(at(ms)).unwrap();
        let proven = admit(0);
        proven.prove();
        let page = admit(1);
        page.become_page();
        let crowd: Vec<_> = (2..100).map(admit).collect();
        let is_closed = |open: &Connection| open.is_closed.load(Ordering::Relaxed);
        assert_eq!(crowd.iter().filter(|open| !is_closed(open)).count(), 2);
        assert!(!is_closed(&proven) && !is_closed(&page));
        crowd.iter().for_each(|open| open.prove());
        admit(100);
        assert!(is_closed(&proven), "of the proven ones the oldest gives way");
        table.remove(&page);
        assert_eq!(table.open().len(), 3);
    }

    #[test]
    fn connections_end_unproven_or_silent() {
        let table = Connections::new(9, Pages::Apart);
        let [silent, proven, page] = [0; 3].map(|ms| table.admit(at(ms)).unwrap());
        proven.prove();
        page.become_page();
        page.prove();
        let closed = || {
            let all = [&silent, &proven, &page];
            all.map(|open| open.is_closed.load(Ordering::Relaxed))
        };
        table.tick(at(9_999));
        assert_eq!(closed(), [false; 3]);
        // Bytes alone prove nothing.
        silent.active.store(at(9_999).ns(), Ordering::Relaxed);
        table.tick(at(10_000));
        assert_eq!(closed(), [true, false, false]);
        proven.active.store(at(20_000).ns(), Ordering::Relaxed);
        table.tick(at(94_999));
        assert_eq!(closed(), [true, false, false]);
        table.tick(at(95_000));
        assert_eq!(closed(), [true, true, false]);
    }

    #[test]
    fn pages_among_the_others_end_silent_and_keep_their_places() {
        let table = Connections::new(2, Pages::Among);
        let pages = [0, 1].map(|ms| table.admit(at(ms)).unwrap());
        pages.iter().for_each(|page| page.become_page());
        assert!(table.admit(at(2)).is_none(), "no page gives way");
        pages[0].active.store(at(20_000).ns(), Ordering::Relaxed);
        table.tick(at(75_001));
        assert_eq!(pages.map(|page| page.is_closed.load(Ordering::Relaxed)), [false, true]);
    }
}
