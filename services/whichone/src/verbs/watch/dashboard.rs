//! `watch` on a terminal: a dashboard with keys.
//!
//! Invariant: nothing here waits. The supervisor's status is awaited and orders to the motion stop are given on
//! threads of their own, so that a service that hangs neither freezes the picture nor delays a stop.

use std::io::{self, Stdout};
use std::sync::mpsc::{Receiver, channel};
use std::thread;
use std::time::{Duration, Instant};

use command_line::Outcome;
use command_line::interrupt::Interrupt;
use command_line::output::Style;
use messages::{Receipt, ReceiptStatus, StopId};
use ratatui::Terminal;
use ratatui::backend::CrosstermBackend;
use ratatui::crossterm::event::{self, Event};
use ratatui::crossterm::execute;
use ratatui::crossterm::terminal::{
    EnterAlternateScreen, LeaveAlternateScreen, disable_raw_mode, enable_raw_mode,
};
use service::clock;
use service::control::{Reply, Request, call};
use service::exit::{Exit, Failure};
use service::group::GroupPaths;
use service::status::GroupStatus;

use super::model::WatchModel;
use super::{STATUS_EVERY, STATUS_PATIENCE};
use crate::verbs::motion::{MotionOrders, News};
use draw::{Notice, Picture, draw};
use keys::{Command, Keyboard};

mod draw;
mod keys;

/// Interval between redraws without a key.
const FRAME_EVERY: Duration = Duration::from_millis(100);
/// Interval at which messages are taken.
const LOOK_EVERY: Duration = Duration::from_millis(20);

/// Shows the dashboard until the user quits. A stop that is not confirmed then is still repeated, until the user
/// interrupts.
pub(super) fn run(model: &mut WatchModel, interrupt: &Interrupt, style: Style) -> Outcome {
    let orders = MotionOrders::open(model.paths())?;
    let shown = show(model, interrupt, style, &orders);
    orders.finish(interrupt, None, shown.map(|()| Exit::Ok))
}

fn show(
    model: &mut WatchModel,
    interrupt: &Interrupt,
    style: Style,
    orders: &MotionOrders,
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
        let news = std::iter::from_fn(|| orders.news()).last();
        notice = news.map(|News { text, is_bad }| Notice { text, is_bad }).or(notice);
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
        let stop = model.latest().arm.map_or(StopId(0), |arm| arm.stop());
        notice = match keyboard.press(key, stop, clock::now()) {
            None => notice,
            Some(Command::Quit) => return Ok(()),
            Some(command) => carry_out(command, model, orders)?.or(notice),
        };
    }
    Ok(())
}

/// Carries out a command of the keyboard; returns what is shown about it.
fn carry_out(
    command: Command,
    model: &mut WatchModel,
    orders: &MotionOrders,
) -> Result<Option<Notice>, Failure> {
    let text = match command {
        Command::Quit => return Ok(None),
        Command::Say(text) => return model.say(&text).map(|()| None),
        Command::TooSoon => "stopped just now; r resumes 2 s after the latest stop",
        Command::Stop => {
            orders.stop();
            "stopping the arm …"
        }
        Command::Release(stop) => {
            orders.release(stop);
            "releasing the motion stop …"
        }
    };
    Ok(Some(Notice::good(text)))
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
