//! `watch` on a terminal: a dashboard with keys.
//!
//! Invariant: nothing here waits. The supervisor's status and orders to the motion stop are awaited on
//! threads of their own, so that a service that hangs neither freezes the picture nor delays a stop.

use std::io::{self, Stdout};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use messages::{MotionOrder, Receipt, ReceiptStatus};
use ratatui::Terminal;
use ratatui::backend::CrosstermBackend;
use ratatui::crossterm::event::{self, Event};
use ratatui::crossterm::execute;
use ratatui::crossterm::terminal::{
    EnterAlternateScreen, LeaveAlternateScreen, disable_raw_mode, enable_raw_mode,
};
use service::control::{Reply, Request, call};
use service::exit::Failure;
use service::group::GroupPaths;
use service::status::GroupStatus;

use super::model::WatchModel;
use super::{STATUS_EVERY, STATUS_PATIENCE};
use crate::output::{Style, note};
use crate::verbs::interrupt::Interrupt;
use crate::verbs::motion;
use draw::{Notice, Picture, draw};
use keys::{Command, Keyboard};

mod draw;
mod keys;

/// Interval between redraws without a key.
const FRAME_EVERY: Duration = Duration::from_millis(100);
/// Interval at which messages are taken.
const LOOK_EVERY: Duration = Duration::from_millis(20);
/// Timeout of an order to the motion stop, as of `stop-motion`.
const ORDER_PATIENCE: Duration = Duration::from_secs(5);

/// Shows the dashboard until the user quits. An order to the motion stop that is not confirmed then is still
/// waited for.
pub(super) fn run(
    model: &mut WatchModel,
    interrupt: &Interrupt,
    style: Style,
) -> Result<(), Failure> {
    let mut orders = Orders::new(model.paths());
    let ended = show(model, interrupt, style, &mut orders);
    if let Some(notice) = orders.finish() {
        note(notice.text());
    }
    ended
}

fn show(
    model: &mut WatchModel,
    interrupt: &Interrupt,
    style: Style,
    orders: &mut Orders,
) -> Result<(), Failure> {
    let mut screen = Screen::open().map_err(Failure::output)?;
    let status = status_of(model.paths());
    let (mut keyboard, mut notice) = (Keyboard::default(), None);
    let mut drawn = None::<Instant>;
    while !interrupt.is_requested() {
        if let Some(refusal) = model.look()?.iter().find_map(|receipt| refusal(model, receipt)) {
            notice = Some(refusal);
        }
        model.status = status.try_iter().last().or(model.status.take());
        notice = orders.news().or(notice);
        if drawn.is_none_or(|drawn| drawn.elapsed() >= FRAME_EVERY) {
            let picture = Picture::of(model, notice.as_ref(), style);
            screen.0.draw(|frame| draw(frame, &picture, &keyboard)).map_err(Failure::output)?;
            drawn = Some(Instant::now());
        }
        if !event::poll(LOOK_EVERY).map_err(Failure::output)? {
            continue;
        }
        drawn = None;
        let Event::Key(key) = event::read().map_err(Failure::output)? else { continue };
        match keyboard.press(key) {
            None => {}
            Some(Command::Quit) => return Ok(()),
            Some(Command::Say(text)) => model.say(&text)?,
            Some(Command::Motion(order)) => notice = Some(orders.give(order)),
        }
    }
    Ok(())
}

/// The reason for which an utterance that was typed here is not accepted.
fn refusal(model: &WatchModel, receipt: &Receipt) -> Option<Notice> {
    let is_refused = receipt.status == ReceiptStatus::Refused && model.is_own(receipt);
    let why = receipt.note.as_str().unwrap_or("no reason was given");
    is_refused.then(|| Notice::bad(format!("not accepted: {why}")))
}

/// The terminal in raw mode, on its alternate screen. It is restored when this is dropped.
struct Screen(Terminal<CrosstermBackend<Stdout>>);

impl Screen {
    fn open() -> io::Result<Self> {
        let terminal = Terminal::new(CrosstermBackend::new(io::stdout()))?;
        // From here on a failure restores the terminal.
        let screen = Self(terminal);
        enable_raw_mode()?;
        execute!(io::stdout(), EnterAlternateScreen)?;
        Ok(screen)
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        // Nothing to do if the terminal is gone.
        let _ = self.0.show_cursor();
        let _ = execute!(io::stdout(), LeaveAlternateScreen);
        let _ = disable_raw_mode();
    }
}

/// The supervisor's answers, asked for now and then as long as they are received.
fn status_of(paths: &GroupPaths) -> Receiver<GroupStatus> {
    let (answers, status) = channel();
    let socket = paths.control_socket();
    thread::spawn(move || {
        loop {
            if let Ok(Reply::Status(status)) = call(&socket, &Request::Status, STATUS_PATIENCE)
                && answers.send(*status).is_err()
            {
                return;
            }
            thread::sleep(STATUS_EVERY);
        }
    });
    status
}

/// Orders to the motion stop. A stop is never kept waiting by an earlier order.
struct Orders {
    paths: GroupPaths,
    results: (Sender<Notice>, Receiver<Notice>),
    pending: Vec<JoinHandle<()>>,
}

impl Orders {
    fn new(paths: &GroupPaths) -> Self {
        Self { paths: paths.clone(), results: channel(), pending: Vec::new() }
    }

    /// Gives an order; [`Orders::news`] has what becomes of it.
    fn give(&mut self, order: MotionOrder) -> Notice {
        let (paths, results) = (self.paths.clone(), self.results.0.clone());
        self.pending.retain(|order| !order.is_finished());
        self.pending.push(thread::spawn(move || {
            let report = |text: String| drop(results.send(Notice::bad(text)));
            let ended = motion::give(&paths, order, ORDER_PATIENCE, report);
            let notice = match ended {
                Ok(state) if !state.stopped => Notice::good("the arm may move"),
                Ok(state) if state.durable => Notice::good("the arm is stopped"),
                Ok(_) => Notice::bad(format!("the arm is stopped; {}", motion::NOT_DURABLE)),
                Err(failure) => Notice::bad(failure.to_string()),
            };
            // The dashboard may be closed.
            let _ = results.send(notice);
        }));
        Notice::good(match order {
            MotionOrder::Stop => "stopping the arm …",
            MotionOrder::Resume => "releasing the motion stop …",
        })
    }

    /// Returns the latest result, if there is a new one.
    fn news(&self) -> Option<Notice> {
        self.results.1.try_iter().last()
    }

    /// Waits for the orders that are not confirmed. Returns the latest result of them.
    fn finish(&mut self) -> Option<Notice> {
        self.pending.retain(|order| !order.is_finished());
        let was_pending = !self.pending.is_empty();
        // One that has panicked has no result.
        self.pending.drain(..).for_each(|order| drop(order.join()));
        self.news().filter(|_| was_pending)
    }
}
