//! The socket of one page, between its browser and its robot's console. Frames pass one by one in each direction; orders wait
//! for the audit, stops for nothing.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use axum::extract::ws::{CloseFrame, Message as Page, WebSocket};
use axum::http::{HeaderMap, HeaderValue, header};
use futures_util::stream::{SplitSink, SplitStream};
use futures_util::{SinkExt, StreamExt};
use roster::Name;
use tokio::net::TcpStream;
use tokio::sync::mpsc::{self, Receiver, Sender};
use tokio::time::{Instant, interval, timeout};
use tokio_tungstenite::tungstenite::Message as Console;
use tokio_tungstenite::tungstenite::client::IntoClientRequest;
use tokio_tungstenite::{WebSocketStream, client_async};

use crate::Gateway;
use crate::audit::{Entry, Outcome};
use crate::people::Right;
use crate::robots;
use crate::rules::{Answered, Order, Verdict, answered, judge, refused};

/// Largest frame of a page, bytes: the console's own limit.
pub(crate) const FRAME_BYTES_MAX: usize = 64 << 10;
/// Frames that wait in one direction. A console sends the newest of everything to a page that is slow.
const QUEUE: usize = 8;
/// Orders that wait for the audit.
const ORDERS: usize = 16;
/// Orders whose outcome is awaited.
const AWAITED_MAX: usize = 256;
/// Orders that are given at once, and how many more each second.
const BUDGET: (f64, f64) = (20.0, 10.0);
/// Longest silence of a page, pongs included.
const SILENCE_MAX: Duration = Duration::from_secs(60);
/// Interval at which the person's rights are looked at.
const RIGHTS_EVERY: Duration = Duration::from_secs(1);
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

/// Whose page it is, and of which robot.
#[derive(Debug)]
pub(crate) struct Visit<'a> {
    gateway: &'a Gateway,
    person: Name,
    robot: Name,
    right: Right,
    /// Number of the connection in the audit.
    number: u64,
    awaited: Mutex<VecDeque<(u64, String)>>,
    budget: Mutex<(f64, Instant)>,
    /// Stops that were given: a release that waits for the audit is void after one.
    stops: AtomicU64,
}

impl<'a> Visit<'a> {
    /// A page of `person`.
    pub(crate) fn new(gateway: &'a Gateway, person: Name, robot: Name, right: Right) -> Self {
        let number = gateway.visits.fetch_add(1, Ordering::Relaxed) + 1;
        Self {
            gateway,
            person,
            robot,
            right,
            number,
            awaited: Mutex::default(),
            budget: Mutex::new((BUDGET.0, Instant::now())),
            stops: AtomicU64::new(0),
        }
    }

    /// Serves the page until one side ends, or the person's rights change.
    pub(crate) async fn serve(self, page: WebSocket, console: ConsoleSocket) {
        self.note("open", Outcome::Done, None, Some(self.right.word().to_owned()));
        let (mut page_out, mut page_in) = page.split();
        let (mut console_out, mut console_in) = console.split();
        let (to_page, for_page) = mpsc::channel(QUEUE);
        let (to_console, for_console) = mpsc::channel(QUEUE);
        let (to_audit, for_audit) = mpsc::channel(ORDERS);
        let (code, reason) = tokio::select! {
            end = write_page(&mut page_out, for_page) => end,
            end = write_console(&mut console_out, for_console) => end,
            end = self.read_page(&mut page_in, &to_console, &to_page, &to_audit) => end,
            end = self.read_console(&mut console_in, &to_page) => end,
            end = self.audit(for_audit, &to_console, &to_page) => end,
            end = self.watch() => end,
        };
        self.note("close", Outcome::Done, None, Some(reason.clone()));
        let frame = CloseFrame { code, reason: short(&reason).into() };
        // Either side may be gone already.
        let _ = timeout(PATIENCE, page_out.send(Page::Close(Some(frame)))).await;
        let _ = timeout(PATIENCE, console_out.send(Console::Close(None))).await;
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
                Page::Text(text) => match judge(&text, &self.person, self.right) {
                    Verdict::Pass(text) => to_console.send(Console::text(text)).await.is_ok(),
                    Verdict::Order(order, text) => {
                        self.order(order, text, to_console, to_page, to_audit).await
                    }
                    Verdict::Refused(order, answer) => {
                        // A page repeats a stop that is refused.
                        if self.has_budget() {
                            self.note_order(&order, Outcome::Refused, order.text.clone());
                        }
                        to_page.send(Page::text(answer)).await.is_ok()
                    }
                    Verdict::Answer(answer) => to_page.send(Page::text(answer)).await.is_ok(),
                },
                Page::Binary(sound) if self.right == Right::Operator => {
                    to_console.send(Console::Binary(sound)).await.is_ok()
                }
                Page::Close(_) => return (1000, "the page was closed".to_owned()),
                Page::Binary(_) | Page::Ping(_) | Page::Pong(_) => true,
            };
            if !sent {
                return (1011, "the other side is gone".to_owned());
            }
        }
    }

    /// Passes a stop on, and hands other orders to the audit; returns whether the page goes on.
    async fn order(
        &self,
        order: Order,
        text: String,
        to_console: &Sender<Console>,
        to_page: &Sender<Page>,
        to_audit: &Sender<(Order, String, u64)>,
    ) -> bool {
        let has_budget = self.has_budget();
        if order.is_stop() {
            self.stops.fetch_add(1, Ordering::Relaxed);
            let sent = to_console.send(Console::text(text)).await.is_ok();
            if has_budget {
                self.note_order(&order, Outcome::Ordered, None);
                self.await_outcome(&order);
            }
            return sent;
        }
        let id = order.id;
        let stops = self.stops.load(Ordering::Relaxed);
        if has_budget && to_audit.try_send((order, text, stops)).is_ok() {
            return true;
        }
        let why = "too many orders at a time; help: wait a moment";
        to_page.send(Page::text(refused(id, why))).await.is_ok()
    }

    /// Records orders, and passes them on once they are on the disk.
    async fn audit(
        &self,
        mut orders: Receiver<(Order, String, u64)>,
        to_console: &Sender<Console>,
        to_page: &Sender<Page>,
    ) -> End {
        while let Some((order, text, stops)) = orders.recv().await {
            let entry =
                self.entry(&order.what, Outcome::Ordered, Some(order.id), order.text.clone());
            let recorded = self.gateway.audit.record(&entry).await;
            let is_void = || order.is_resume() && stops != self.stops.load(Ordering::Relaxed);
            let why = match recorded {
                Err(error) => Some(format!(
                    "not ordered, as it cannot be recorded: {error}; help: see the gateway's disk"
                )),
                Ok(()) if is_void() => Some("a stop was given meanwhile".to_owned()),
                Ok(()) => None,
            };
            let sent = match why {
                None => {
                    self.await_outcome(&order);
                    to_console.send(Console::text(text)).await.is_ok()
                }
                Some(why) => {
                    let answer = refused(order.id, &why);
                    self.note_order(&order, Outcome::Refused, Some(why));
                    to_page.send(Page::text(answer)).await.is_ok()
                }
            };
            if !sent {
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

    /// Ends the page when its person's rights change, or the gateway ends.
    async fn watch(&self) -> End {
        let mut look = interval(RIGHTS_EVERY);
        let mut ending = self.gateway.ending.subscribe();
        loop {
            tokio::select! {
                _ = look.tick() => {}
                _ = ending.wait_for(|ending| *ending) => return (1001, "the gateway ends".to_owned()),
            }
            let now = self.gateway.people.current().right(&self.person, &self.robot);
            if now != Some(self.right) {
                return (1008, "the person's rights have changed".to_owned());
            }
        }
    }

    fn await_outcome(&self, order: &Order) {
        let mut awaited = self.awaited.lock().unwrap_or_else(PoisonError::into_inner);
        if awaited.len() >= AWAITED_MAX {
            awaited.pop_front();
        }
        awaited.push_back((order.id, order.what.clone()));
    }

    fn outcome(&self, answer: Answered) {
        match answer {
            Answered::Heard(text) => self.note("speech", Outcome::Done, None, Some(text)),
            Answered::Done(id, result) => {
                let mut awaited = self.awaited.lock().unwrap_or_else(PoisonError::into_inner);
                let place = awaited.iter().position(|(known, _)| *known == id);
                let Some((_, what)) = place.and_then(|place| awaited.remove(place)) else { return };
                drop(awaited);
                let outcome = if result.is_ok() { Outcome::Done } else { Outcome::Failed };
                self.note(&what, outcome, Some(id), result.err());
            }
        }
    }

    /// Returns whether the page may give one more order now.
    fn has_budget(&self) -> bool {
        let mut budget = self.budget.lock().unwrap_or_else(PoisonError::into_inner);
        let now = Instant::now();
        let more = now.duration_since(budget.1).as_secs_f64() * BUDGET.1;
        *budget = ((budget.0 + more).min(BUDGET.0), now);
        let has = budget.0 >= 1.0;
        budget.0 -= f64::from(u8::from(has));
        has
    }

    fn note_order(&self, order: &Order, outcome: Outcome, text: Option<String>) {
        self.note(&order.what, outcome, Some(order.id), text);
    }

    fn note(&self, what: &str, outcome: Outcome, id: Option<u64>, text: Option<String>) {
        self.gateway.audit.note(&self.entry(what, outcome, id, text));
    }

    fn entry(&self, what: &str, outcome: Outcome, id: Option<u64>, text: Option<String>) -> Entry {
        let order = Some((self.number, id.unwrap_or(0)));
        Entry { text, order, ..Entry::new(&self.person, Some(&self.robot), what, outcome) }
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
