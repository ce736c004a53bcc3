//! The socket of one page: its messages go to the hub, changes of the board go to it.

use std::sync::Arc;
use std::time::Duration;

use axum::extract::ws::{CloseFrame, Message as Frame, WebSocket, close_code};
use futures_util::stream::{SplitSink, SplitStream};
use futures_util::{SinkExt, StreamExt};
use service::clock;
use tokio::sync::mpsc;
use tokio::time::{Instant, interval_at, sleep_until, timeout};
use tungstenite::Error as SocketError;
use tungstenite::error::ProtocolError;
use web_server::connections::Connection;

use super::App;
use super::message::{self, Do, FRAME_BYTES_MAX, Hello, Message, PROTOCOL};
use crate::hub::board::Cursor;
use crate::hub::outbound::{Done, PageMessage, Welcome};
use crate::hub::{Hub, OutboundFrame, ViewerId, ms};
use crate::voice::PcmFrame;

/// Deadline for a page's first message.
const HELLO_PATIENCE: Duration = Duration::from_secs(10);
/// Timeout for writing a frame to a page.
const READ_PATIENCE: Duration = Duration::from_secs(10);
/// Longest silence of a page, pongs included.
const SILENCE_MAX: Duration = Duration::from_secs(60);
/// Shortest average time between two frames read from a page, and frames read at once.
const FRAME_EVERY: Duration = Duration::from_micros(500);
const FRAMES_AT_ONCE: u32 = 500;
/// Close code of a page that was replaced by another one of its session.
const REPLACED: u16 = 4001;
/// Close code of a page that gave way to an operator.
const GAVE_WAY: u16 = 4002;
/// Interval between pings to a page.
pub(crate) const PROBE_EVERY: Duration = Duration::from_secs(20);

pub(crate) type Out = SplitSink<WebSocket, Frame>;
type In = SplitStream<WebSocket>;

/// Serves one page until it goes, does not read, or the console ends.
pub(super) async fn serve(socket: WebSocket, connection: Arc<Connection>, app: Arc<App>) {
    let (mut out, mut into) = socket.split();
    let hello = match first(&mut into).await {
        Ok(hello) => hello,
        Err(why) => return refuse(&mut out, close_code::POLICY, &why).await,
    };
    let Hello { session, name, last_line, role } = hello;
    let (viewer, outbound) = match app.hub.join(&name, &session, role, clock::now()) {
        Ok(joined) => joined,
        Err(why) => return refuse(&mut out, close_code::AGAIN, &why).await,
    };
    connection.become_page();
    tracing::info!(%viewer, ?role, "a page has connected");
    let ended = tokio::select! {
        ended = write(&mut out, outbound, viewer, last_line, &app) => ended,
        ended = read(&mut into, viewer, &app.hub) => ended,
    };
    app.hub.leave(viewer, clock::now());
    tracing::info!(%viewer, "a page has disconnected: {ended:?}");
    if matches!(ended, Ended::Slow) {
        app.hub.metrics.dropped.inc();
    }
    let (code, reason) = ended.close_frame();
    close(&mut out, code, reason).await;
}

/// The reason for the end of a socket.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Ended {
    Page,
    Replaced,
    GaveWay,
    Slow,
    /// No frame arrived, not even a pong.
    Silent,
    /// The page sent a message above [`FRAME_BYTES_MAX`].
    TooLong,
    /// The page sent a text that is not UTF-8.
    NotText,
    /// The page broke the protocol.
    Protocol,
    Console,
}

impl Ended {
    /// Returns the code and reason with which the socket is closed.
    pub(crate) fn close_frame(self) -> (u16, &'static str) {
        match self {
            Self::Console => (close_code::AWAY, "the console ends"),
            Self::Slow => (close_code::POLICY, "the page did not read for 10 s"),
            Self::Replaced => (REPLACED, "the same page is open somewhere else"),
            Self::GaveWay => {
                (GAVE_WAY, "too many pages are open; this one was idle for the longest time")
            }
            Self::Silent => (close_code::POLICY, "nothing was received for 60 s"),
            Self::TooLong => (close_code::SIZE, "expected a message of at most 65536 bytes"),
            Self::NotText => (close_code::INVALID, "expected a text in UTF-8"),
            Self::Protocol => (close_code::PROTOCOL, "expected frames of the WebSocket protocol"),
            Self::Page => (close_code::NORMAL, ""),
        }
    }
}

const _: () = assert!(FRAME_BYTES_MAX == 65_536, "the reason says so");

impl From<axum::Error> for Ended {
    /// The reason why a frame cannot be read.
    fn from(error: axum::Error) -> Self {
        match error.into_inner().downcast_ref::<SocketError>() {
            Some(SocketError::Capacity(_)) => Self::TooLong,
            Some(SocketError::Utf8(_)) => Self::NotText,
            Some(SocketError::Protocol(ProtocolError::ResetWithoutClosingHandshake)) => Self::Page,
            Some(SocketError::Protocol(_)) => Self::Protocol,
            _ => Self::Page,
        }
    }
}

async fn first(into: &mut In) -> Result<Hello, String> {
    let said = timeout(HELLO_PATIENCE, into.next()).await;
    match said.map_err(|_| "no hello within 10 s")? {
        Some(Ok(Frame::Text(text))) => message::hello(&text),
        _ => Err("expected a hello first".to_owned()),
    }
}

async fn refuse(out: &mut Out, code: u16, why: &str) {
    let text = PageMessage::Error { error: why }.to_text();
    let _ = timeout(READ_PATIENCE, out.send(Frame::Text(text.into()))).await;
    close(out, code, why).await;
}

pub(crate) async fn close(out: &mut Out, code: u16, reason: &str) {
    // A reason may have 123 bytes.
    let end = (0..=reason.len().min(120)).rev().find(|end| reason.is_char_boundary(*end));
    let reason = reason[..end.unwrap_or(0)].to_owned();
    let frame = Frame::Close(Some(CloseFrame { code, reason: reason.into() }));
    // The other side may be gone already.
    let _ = timeout(Duration::from_secs(1), out.send(frame)).await;
}

async fn write(
    out: &mut Out,
    mut outbound: mpsc::Receiver<OutboundFrame>,
    viewer: ViewerId,
    last_line: u64,
    app: &App,
) -> Ended {
    let hub = &app.hub;
    let (mut changed, mut ending) = (hub.board.watch(), hub.ending());
    let mut cursor = Cursor::after_line(last_line);
    let mut probe = interval_at(Instant::now() + PROBE_EVERY, PROBE_EVERY);
    let mut frames = vec![Frame::Text(welcome(viewer, app).into())];
    loop {
        let news = hub.board.news(&mut cursor);
        frames.extend(news.into_iter().map(|text| Frame::Text(text.into())));
        for frame in frames.drain(..) {
            if let Err(ended) = send(out, frame, hub).await {
                return ended;
            }
        }
        tokio::select! {
            changed = changed.changed() => if changed.is_err() { return Ended::Console },
            _ = ending.wait_for(|ending| *ending) => return Ended::Console,
            frame = outbound.recv() => match frame {
                Some(OutboundFrame::Text(frame)) => frames.push(Frame::Text(frame.into())),
                Some(OutboundFrame::Answer(id, outcome)) => {
                    let done = PageMessage::Done(Done::new(id, &outcome));
                    frames.push(Frame::Text(done.to_text().into()));
                }
                Some(OutboundFrame::Replaced) => return Ended::Replaced,
                Some(OutboundFrame::GaveWay) => return Ended::GaveWay,
                None => return Ended::Slow,
            },
            _ = probe.tick() => frames.push(Frame::Ping(Vec::new().into())),
        }
    }
}

pub(crate) async fn send(out: &mut Out, frame: Frame, hub: &Hub) -> Result<(), Ended> {
    let bytes = match &frame {
        Frame::Text(text) => text.len(),
        Frame::Binary(bytes) => bytes.len(),
        _ => 0,
    };
    match timeout(READ_PATIENCE, out.send(frame)).await {
        Ok(Ok(())) => {
            hub.metrics.frames.inc();
            hub.metrics.bytes.inc_by(bytes as u64);
            Ok(())
        }
        Ok(Err(_)) => Err(Ended::Page),
        Err(_) => Err(Ended::Slow),
    }
}

fn welcome(viewer: ViewerId, app: &App) -> String {
    let version = build_info::full_version();
    let welcome = Welcome {
        protocol: PROTOCOL,
        viewer: viewer.to_string(),
        version: &version,
        group: &app.group,
        server_ms: ms(clock::now()),
        first_line: app.hub.board.first_line(),
        settings: &app.settings,
    };
    PageMessage::Welcome(welcome).to_text()
}

/// The pace at which frames of one socket are read.
#[derive(Debug)]
pub(crate) struct Pace(Instant);

impl Default for Pace {
    fn default() -> Self {
        Self(Instant::now())
    }
}

impl Pace {
    /// Reads the next frame.
    ///
    /// # Errors
    /// The socket is closed, broken or silent for too long.
    pub(crate) async fn next(&mut self, into: &mut In) -> Result<Frame, Ended> {
        // One that sends faster waits, and fills its own connection only.
        self.0 = self.0.max(Instant::now() - FRAME_EVERY * FRAMES_AT_ONCE) + FRAME_EVERY;
        sleep_until(self.0).await;
        let next = timeout(SILENCE_MAX, into.next()).await.map_err(|_| Ended::Silent)?;
        match next.ok_or(Ended::Page)?? {
            Frame::Close(_) => Err(Ended::Page),
            frame => Ok(frame),
        }
    }
}

async fn read(into: &mut In, viewer: ViewerId, hub: &Hub) -> Ended {
    let mut pace = Pace::default();
    loop {
        match pace.next(into).await {
            Ok(Frame::Text(text)) => text_frame(&text, viewer, hub),
            Ok(Frame::Binary(bytes)) => {
                let taken = PcmFrame::read(&bytes).and_then(|frame| hub.sound(viewer, frame));
                if let Err(why) = taken {
                    hub.error(viewer, &why);
                }
            }
            Ok(_) => {}
            Err(ended) => return ended,
        }
    }
}

fn text_frame(text: &str, viewer: ViewerId, hub: &Hub) {
    let now = clock::now();
    match message::message(text, now) {
        Ok(Message::Ping(at)) => {
            hub.send(viewer, &PageMessage::Pong { at: &at, server_ms: ms(now) });
        }
        Ok(Message::Do(id, what)) => {
            hub.note(viewer, now);
            // Others than control are answered by those who carry them out.
            let passed_on = match what {
                Do::Ask(verb) => hub.ask(viewer, id, verb),
                Do::Stop => hub.stop(viewer, id),
                Do::Release(stop) => hub.release(viewer, id, stop),
                Do::Restart(service) => hub.restart(viewer, id, service),
                Do::Take => return hub.answer(viewer, id, hub.take_control(viewer, now)),
                Do::Give(to) => return hub.answer(viewer, id, hub.give_control(viewer, to)),
                Do::Keep => return hub.answer(viewer, id, hub.keep_control(viewer)),
            };
            if let Err(why) = passed_on {
                hub.answer(viewer, id, Err(why));
            }
        }
        Ok(Message::Wrong(id, why)) => hub.answer(viewer, id, Err(why)),
        Err(why) => hub.error(viewer, &why),
    }
}
