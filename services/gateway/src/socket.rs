//! The socket of one page, between its browser and its robot's console. Frames pass one by one in
//! each direction; orders wait for the audit, stops for nothing.

use std::collections::VecDeque;
use std::pin::pin;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Duration;

use axum::extract::ws::{CloseFrame, Message as Page, WebSocket};
use axum::http::{HeaderMap, HeaderValue, header};
use futures_util::stream::{SplitSink, SplitStream};
use futures_util::{SinkExt, StreamExt};
use roster::Name;
use tokio::net::TcpStream;
use tokio::sync::mpsc::{self, Receiver, Sender};
use tokio::time::{interval, timeout};
use tokio_tungstenite::tungstenite::Message as Console;
use tokio_tungstenite::tungstenite::client::IntoClientRequest;
use tokio_tungstenite::{WebSocketStream, client_async};

use crate::access::Known;
use crate::audit::Outcome;
use crate::people::Right;
use crate::rules::{Order, Verdict, answered, error, judge, refused};
use crate::sounds::{self, Sounds};
use crate::{Gateway, robots};

mod notes;

/// Largest frame of a page, bytes: the console's own limit.
pub(crate) const FRAME_BYTES_MAX: usize = 64 << 10;
/// Frames that wait in one direction. A console sends only the newest state to a slow page.
const QUEUE: usize = 8;
/// Orders that wait for the audit.
const ORDERS: usize = 16;
/// Orders whose outcome is awaited.
const AWAITED_MAX: usize = 256;
/// Longest silence of a page, pongs included.
const SILENCE_MAX: Duration = Duration::from_secs(60);
/// Interval at which the person's rights and session are looked at.
const RIGHTS_EVERY: Duration = Duration::from_millis(500);
/// Timeout for the robot's results on the sound of a page that is gone.
const HEARD_WITHIN: Duration = Duration::from_secs(5);
const REVOKED: &str = "the person's rights have changed, or the session has ended";
/// Timeout of a console's greeting, and of a goodbye.
const PATIENCE: Duration = Duration::from_secs(5);

/// A socket to a console.
pub(crate) type ConsoleSocket = WebSocketStream<TcpStream>;
/// Close code and reason.
type End = (u16, String);

/// Opens a console's socket for a page that sends these headers.
///
/// # Errors
/// The console does not answer, or refuses.
pub(crate) async fn open(
    console: &robots::Console,
    headers: &HeaderMap,
) -> Result<ConsoleSocket, String> {
    let text = |error: &dyn std::fmt::Display| format!("the robot's console: {error}");
    let request = format!("ws://{}/ws", console.place).into_client_request();
    let mut request = request.map_err(|error| text(&error))?;
    // The console compares them once more.
    for name in [header::HOST, header::ORIGIN] {
        if let Some(value) = headers.get(&name) {
            request.headers_mut().insert(name, value.clone());
        }
    }
    let bearer = HeaderValue::from_str(&format!("Bearer {}", console.token));
    request.headers_mut().insert(header::AUTHORIZATION, bearer.map_err(|error| text(&error))?);
    let open = async {
        let stream = TcpStream::connect(&console.place).await.map_err(|error| text(&error))?;
        stream.set_nodelay(true).map_err(|error| text(&error))?;
        client_async(request, stream).await.map_err(|error| text(&error))
    };
    match timeout(PATIENCE, open).await {
        Ok(opened) => opened.map(|(socket, _)| socket),
        Err(_) => Err(text(&"no answer within 5 s")),
    }
}

/// A page's person and robot.
#[derive(Debug)]
pub(crate) struct Visit<'a> {
    gateway: &'a Gateway,
    known: Known,
    robot: Name,
    right: Right,
    /// Number of the connection in the audit.
    number: u64,
    awaited: Mutex<VecDeque<(u64, String)>>,
    sounds: Sounds,
    /// Stops that were given: a release that waits for the audit is void after one.
    stops: AtomicU64,
    /// Stops without an entry in the audit so far.
    uncounted_stops: AtomicU64,
    /// Why nothing more is passed on, once the person may not order any more.
    is_revoked: AtomicBool,
}

impl<'a> Visit<'a> {
    /// A page of a person.
    pub(crate) fn new(gateway: &'a Gateway, known: Known, robot: Name, right: Right) -> Self {
        let number = gateway.visits.fetch_add(1, Ordering::Relaxed) + 1;
        Self {
            gateway,
            known,
            robot,
            right,
            number,
            awaited: Mutex::default(),
            sounds: Sounds::default(),
            stops: AtomicU64::new(0),
            uncounted_stops: AtomicU64::new(0),
            is_revoked: AtomicBool::new(false),
        }
    }

    /// Serves the page until one side ends, or the person may not see the robot any more. Orders of
    /// the page until then are passed on, and its words recorded, though it is gone.
    pub(crate) async fn serve(self, page: WebSocket, console: ConsoleSocket) {
        self.note("open", Outcome::Done, None, Some(self.right.word().to_owned()));
        let (mut page_out, mut page_in) = page.split();
        let (mut console_out, mut console_in) = console.split();
        let (code, reason) =
            self.pass(&mut page_out, &mut page_in, &mut console_out, &mut console_in).await;
        let frame = CloseFrame { code, reason: short(&reason).into() };
        // Either side may be gone already.
        let _ = timeout(PATIENCE, page_out.send(Page::Close(Some(frame)))).await;
        self.hear_out(&mut console_out, &mut console_in).await;
        self.note_more_stops();
        self.note("close", Outcome::Done, None, Some(reason));
        let _ = timeout(PATIENCE, console_out.send(Console::Close(None))).await;
    }

    /// Passes frames between both sides.
    async fn pass(
        &self,
        page_out: &mut SplitSink<WebSocket, Page>,
        page_in: &mut SplitStream<WebSocket>,
        console_out: &mut SplitSink<ConsoleSocket, Console>,
        console_in: &mut SplitStream<ConsoleSocket>,
    ) -> End {
        let (to_page, for_page) = mpsc::channel(QUEUE);
        let (to_console, for_console) = mpsc::channel(QUEUE);
        let (to_audit, for_audit) = mpsc::channel(ORDERS);
        let mut auditing = pin!(self.audit(for_audit, to_console.clone(), to_page.clone()));
        let mut writing = pin!(write_console(console_out, for_console));
        let end = tokio::select! {
            end = &mut auditing => return end,
            end = &mut writing => return end,
            end = self.read_console(console_in, &to_page) => return end,
            end = write_page(page_out, for_page) => end,
            end = self.read_page(page_in, &to_console, &to_page, &to_audit) => end,
            end = self.watch() => end,
        };
        drop((to_console, to_page, to_audit));
        let _ = timeout(PATIENCE, async { tokio::join!(auditing, writing) }).await;
        end
    }

    /// Ends the page's streams of sound, and records the words that the robot still hears in them.
    async fn hear_out(
        &self,
        console_out: &mut SplitSink<ConsoleSocket, Console>,
        console_in: &mut SplitStream<ConsoleSocket>,
    ) {
        let hear = async {
            for end in self.sounds.ends() {
                console_out.send(Console::binary(end)).await.ok()?;
            }
            while !self.sounds.are_over() {
                if let Console::Text(text) = console_in.next().await?.ok()? {
                    answered(&text).into_iter().for_each(|answer| self.outcome(answer));
                }
            }
            Some(())
        };
        if !matches!(timeout(HEARD_WITHIN, hear).await, Ok(Some(()))) {
            let why = "the page was gone before its words were known".to_owned();
            self.note("speech", Outcome::Failed, None, Some(why));
        }
    }

    async fn read_page(
        &self,
        page: &mut SplitStream<WebSocket>,
        to_console: &Sender<Console>,
        to_page: &Sender<Page>,
        to_audit: &Sender<(Order, String, u64)>,
    ) -> End {
        loop {
            let frame = match timeout(SILENCE_MAX, page.next()).await {
                Ok(Some(Ok(frame))) => frame,
                Ok(Some(Err(error))) => return (1002, format!("the page's socket: {error}")),
                Ok(None) => return (1000, "the page was closed".to_owned()),
                Err(_) => return (1008, "nothing was received for 60 s".to_owned()),
            };
            let sent = match frame {
                Page::Text(text) => match judge(&text, &self.known.person, self.right) {
                    Verdict::Pass(text) => to_console.send(Console::text(text)).await.is_ok(),
                    Verdict::Order(order, text) => {
                        self.order(order, text, to_console, to_page, to_audit).await
                    }
                    Verdict::Refused(order, answer) => {
                        // A page repeats a stop that is refused.
                        if self.has_budget() {
                            self.gateway.audit.note(&self.entry_of(&order, Outcome::Refused));
                        }
                        to_page.send(Page::text(answer)).await.is_ok()
                    }
                    Verdict::Answer(answer) => to_page.send(Page::text(answer)).await.is_ok(),
                },
                Page::Binary(sound) if self.right == Right::Operator => {
                    match self.admit_sound(&sound) {
                        Ok(()) => to_console.send(Console::Binary(sound)).await.is_ok(),
                        Err(why) => to_page.send(Page::text(error(why))).await.is_ok(),
                    }
                }
                Page::Close(_) => return (1000, "the page was closed".to_owned()),
                Page::Binary(_) | Page::Ping(_) | Page::Pong(_) => true,
            };
            if !sent {
                return (1011, "the other side is gone".to_owned());
            }
        }
    }

    /// Records a stream of sound that begins.
    fn admit_sound(&self, sound: &[u8]) -> Result<(), &'static str> {
        let frame = sounds::Frame::read(sound).ok_or("expected a frame of sound")?;
        let is_recorded = || {
            let stream = format!("stream {}", frame.stream());
            self.has_budget() && self.note("sound", Outcome::Ordered, None, Some(stream))
        };
        if self.sounds.is_new(&frame) && !is_recorded() || !self.sounds.take(frame) {
            return Err("too much sound at a time; help: wait a moment");
        }
        Ok(())
    }

    /// Passes a stop on, and hands other orders to the audit; returns whether the page continues.
    async fn order(
        &self,
        order: Order,
        text: String,
        to_console: &Sender<Console>,
        to_page: &Sender<Page>,
        to_audit: &Sender<(Order, String, u64)>,
    ) -> bool {
        if order.is_stop() {
            self.stops.fetch_add(1, Ordering::Relaxed);
            let sent = to_console.send(Console::text(text)).await.is_ok();
            self.note_stop(&order);
            return sent;
        }
        let id = order.id;
        let stops = self.stops.load(Ordering::Relaxed);
        if self.has_budget() && to_audit.try_send((order, text, stops)).is_ok() {
            return true;
        }
        let why = "too many orders at a time; help: wait a moment";
        to_page.send(Page::text(refused(id, why))).await.is_ok()
    }

    /// Records orders, and passes them on once they are on the disk.
    async fn audit(
        &self,
        mut orders: Receiver<(Order, String, u64)>,
        to_console: Sender<Console>,
        to_page: Sender<Page>,
    ) -> End {
        while let Some((order, text, stops)) = orders.recv().await {
            let recorded =
                self.gateway.audit.record(&self.entry_of(&order, Outcome::Ordered)).await;
            let is_void = || order.is_resume() && stops != self.stops.load(Ordering::Relaxed);
            let why = match recorded {
                Err(error) => Some(format!(
                    "not ordered, as it cannot be recorded: {error}; help: see the gateway's disk"
                )),
                Ok(()) if is_void() => Some("a stop was given meanwhile".to_owned()),
                Ok(()) if self.is_revoked.load(Ordering::Relaxed) => Some(REVOKED.to_owned()),
                Ok(()) => None,
            };
            if let Some(why) = why {
                let answer = refused(order.id, &why);
                self.note_order(&order, Outcome::Refused, Some(why));
                // The page may be gone.
                let _ = to_page.send(Page::text(answer)).await;
                continue;
            }
            self.await_outcome(&order);
            if to_console.send(Console::text(text)).await.is_err() {
                break;
            }
        }
        (1011, "the other side is gone".to_owned())
    }

    async fn read_console(
        &self,
        console: &mut SplitStream<ConsoleSocket>,
        to_page: &Sender<Page>,
    ) -> End {
        loop {
            let frame = match console.next().await {
                Some(Ok(Console::Text(text))) => {
                    if let Some(answer) = answered(&text) {
                        self.outcome(answer);
                    }
                    Page::text(text.as_str())
                }
                Some(Ok(Console::Binary(bytes))) => Page::Binary(bytes),
                // The page answers them, so that its silence is noticed.
                Some(Ok(Console::Ping(bytes))) => Page::Ping(bytes),
                Some(Ok(Console::Close(frame))) => {
                    let end = frame.map(|frame| (frame.code.into(), frame.reason.to_string()));
                    return end.unwrap_or((1001, "the console has closed the socket".to_owned()));
                }
                Some(Ok(Console::Pong(_) | Console::Frame(_))) => continue,
                Some(Err(error)) => return (1001, format!("the console's socket: {error}")),
                None => return (1001, "the console is gone".to_owned()),
            };
            if to_page.send(frame).await.is_err() {
                return (1011, "the page is gone".to_owned());
            }
        }
    }

    /// Ends the page when its person's rights change, the session ends, or the gateway does.
    async fn watch(&self) -> End {
        let mut look = interval(RIGHTS_EVERY);
        let mut ending = self.gateway.ending.subscribe();
        loop {
            tokio::select! {
                _ = look.tick() => {}
                _ = ending.wait_for(|ending| *ending) => return (1001, "the gateway ends".to_owned()),
            }
            self.note_more_stops();
            let people = self.gateway.people.current();
            let has_right = people.right(&self.known.person, &self.robot) == Some(self.right);
            if !has_right || !self.known.lasts(&people, &self.gateway.sessions) {
                self.is_revoked.store(true, Ordering::Relaxed);
                return (1008, REVOKED.to_owned());
            }
        }
    }

    /// Returns whether the person may give one more order now.
    fn has_budget(&self) -> bool {
        self.gateway.budgets.take(&self.known.person)
    }
}

async fn write_page(page: &mut SplitSink<WebSocket, Page>, mut frames: Receiver<Page>) -> End {
    while let Some(frame) = frames.recv().await {
        if page.send(frame).await.is_err() {
            break;
        }
    }
    (1001, "the page is gone".to_owned())
}

async fn write_console(
    console: &mut SplitSink<ConsoleSocket, Console>,
    mut frames: Receiver<Console>,
) -> End {
    while let Some(frame) = frames.recv().await {
        if console.send(frame).await.is_err() {
            break;
        }
    }
    (1001, "the console is gone".to_owned())
}

/// A reason may have 123 bytes.
fn short(reason: &str) -> String {
    let end = (0..=reason.len().min(120)).rev().find(|end| reason.is_char_boundary(*end));
    reason[..end.unwrap_or(0)].to_owned()
}
