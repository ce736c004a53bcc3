//! The open connections: bounded in number and in the time that they may take.
//!
//! A connection proves itself by a request with the token or a session. One that has not, gives way to
//! newer ones and ends after [`PROOF_PATIENCE`] whatever it does; a proven one ends when it is idle. A page's
//! socket is counted among the viewers instead. So descriptors are left for the next visitor, whatever the
//! others do or leave undone.

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

/// Most connections besides those of pages.
const OTHERS_MAX: usize = 96;
/// Fewest connections besides those of pages: a browser opens six to load a page.
const OTHERS_MIN: usize = 16;
/// Descriptors that are kept for everything else.
const RESERVE: usize = 32;
/// Life of a connection without a request that proves it.
const PROOF_PATIENCE: Span = Span::from_ms(10_000);
/// Longest silence of a proven connection.
const IDLE_MAX: Span = Span::from_ms(75_000);
/// Pause after a failure to accept: no descriptor is left.
const PAUSE: Duration = Duration::from_millis(20);

/// Numbers of connections that a limit of descriptors allows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Pages.
    pub viewers: usize,
    /// Connections besides.
    pub others: usize,
}

impl Limits {
    /// Returns the descriptors that are ever used with so many pages.
    pub fn most(viewers_max: usize) -> usize {
        RESERVE + viewers_max + OTHERS_MAX
    }

    /// Divides `free` descriptors: first what a page needs to load, then pages, then more connections.
    pub fn new(viewers_max: usize, free: usize) -> Self {
        let free = free.saturating_sub(RESERVE);
        let viewers = viewers_max.min(free.saturating_sub(OTHERS_MIN)).max(2);
        let others = free.saturating_sub(viewers).clamp(OTHERS_MIN, OTHERS_MAX);
        Self { viewers, others }
    }
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
    /// When bytes went last, nanoseconds.
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

    /// Notes a request with the token or a session.
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

    fn is_expired(&self, now: Time) -> bool {
        if self.is(Stage::Unproven) {
            return now.since(self.began) >= PROOF_PATIENCE;
        }
        let active = Time(self.active.load(Ordering::Relaxed));
        self.is(Stage::Proven) && now.since(active) >= IDLE_MAX
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

    fn note(&self, is_active: bool) {
        if is_active {
            self.active.store(clock::now().ns(), Ordering::Relaxed);
        }
    }
}

/// The table of open connections, oldest first.
#[derive(Debug)]
pub struct Connections {
    open: Mutex<Vec<Arc<Connection>>>,
    others_max: usize,
}

impl Connections {
    /// Makes an empty table for `others_max` connections besides pages.
    pub fn new(others_max: usize) -> Self {
        Self { open: Mutex::default(), others_max }
    }

    /// Ends connections whose time is over. Returns whether there are any connections.
    pub fn tick(&self, now: Time) -> bool {
        let open = self.open();
        open.iter().filter(|open| open.is_expired(now)).for_each(|open| open.close());
        !open.is_empty()
    }

    /// Admits a new connection; where there are too many, the oldest unproven one gives way, or else the
    /// oldest proven one.
    fn admit(&self, now: Time) -> Arc<Connection> {
        let mut open = self.open();
        let others = open.iter().filter(|open| !open.is(Stage::Page)).count();
        if others >= self.others_max {
            let oldest = [Stage::Unproven, Stage::Proven];
            let oldest = oldest.iter().find_map(|stage| open.iter().position(|it| it.is(*stage)));
            oldest.into_iter().for_each(|at| open.remove(at).close());
        }
        let connection = Arc::new(Connection::new(now));
        open.push(Arc::clone(&connection));
        connection
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
    pub listener: TcpListener,
    pub table: Arc<Connections>,
}

impl Listener for Gate {
    type Io = Guarded;
    type Addr = SocketAddr;

    async fn accept(&mut self) -> (Guarded, SocketAddr) {
        loop {
            match self.listener.accept().await {
                Ok((stream, address)) => {
                    let table = Arc::clone(&self.table);
                    let connection = table.admit(clock::now());
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
        self.connection.note(buf.filled().len() > before);
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
        let written = Pin::new(&mut self.stream).poll_write(cx, bytes);
        self.connection.note(matches!(written, Poll::Ready(Ok(1..))));
        written
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
        let table = Connections::new(3);
        let proven = table.admit(at(0));
        proven.prove();
        let page = table.admit(at(1));
        page.become_page();
        let crowd: Vec<_> = (2..100).map(|ms| table.admit(at(ms))).collect();
        let is_closed = |open: &Connection| open.is_closed.load(Ordering::Relaxed);
        assert_eq!(crowd.iter().filter(|open| !is_closed(open)).count(), 2);
        assert!(!is_closed(&proven) && !is_closed(&page));
        crowd.iter().for_each(|open| open.prove());
        table.admit(at(100));
        assert!(is_closed(&proven), "of the proven ones the oldest gives way");
        table.remove(&page);
        assert_eq!(table.open().len(), 3);
    }

    #[test]
    fn connections_end_unproven_or_idle() {
        let table = Connections::new(9);
        let (silent, proven, page) = (table.admit(at(0)), table.admit(at(0)), table.admit(at(0)));
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
    fn limits_fit_the_descriptors() {
        let limits = |viewers, others| Limits { viewers, others };
        assert_eq!(Limits::new(32, 100_000), limits(32, OTHERS_MAX));
        assert_eq!(Limits::new(32, 120), limits(32, 56));
        assert_eq!(Limits::new(32, 70), limits(22, OTHERS_MIN));
        assert_eq!(Limits::new(32, 0), limits(2, OTHERS_MIN));
        let most = Limits::most(32);
        assert_eq!(Limits::new(32, most), Limits::new(32, 100_000));
        assert_ne!(Limits::new(32, most - 1), Limits::new(32, most));
    }
}
