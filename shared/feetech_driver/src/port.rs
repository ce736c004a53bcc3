//! The thread that uses the bus, and its mailbox. It carries goals to the servos and readings back; it decides nothing.

use std::collections::VecDeque;
use std::fmt;
use std::io;
use std::path::PathBuf;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use arm_driver::Port;
use messages::robot::{Order, Report};
use service::bus::PortError;
use service::exit::Exit;

use crate::layout::Layout;
use crate::line::SerialLine;
use crate::session::{Ended, Limits, Session};
use crate::traffic::{Heard, Told};

/// Longest pause between two exchanges: 50 readings a second without orders.
const PAUSE_MAX: Duration = Duration::from_millis(20);
/// Pause before the port is opened again.
const REOPEN_EVERY: Duration = Duration::from_secs(1);
/// Most readings that wait for the arm: of a second. Older ones are dropped.
const WAITING_MAX: usize = 100;

/// Everything that the thread needs.
#[derive(Clone, Debug)]
pub(crate) struct Use {
    pub(crate) port: PathBuf,
    pub(crate) baud: u32,
    pub(crate) layout: Layout,
    pub(crate) limits: Limits,
}

/// The way to the servos.
pub(crate) struct ServoPort {
    mailbox: Arc<Mailbox>,
    thread: Option<JoinHandle<()>>,
}

#[derive(Debug, Default)]
struct Mailbox {
    content: Mutex<Content>,
    changed: Condvar,
}

#[derive(Debug, Default)]
struct Content {
    heard: VecDeque<Heard>,
    told: Told,
    /// An order that the thread has not carried out.
    is_new: bool,
    ends: bool,
}

impl Mailbox {
    fn content(&self) -> MutexGuard<'_, Content> {
        self.content.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn put(&self, heard: Heard) {
        let mut content = self.content();
        if content.heard.len() == WAITING_MAX {
            content.heard.pop_front();
        }
        content.heard.push_back(heard);
    }

    /// Waits for so long. Returns whether the end has come.
    fn ends_within(&self, longest: Duration) -> bool {
        let waited = self.changed.wait_timeout_while(self.content(), longest, |it| !it.ends);
        waited.unwrap_or_else(PoisonError::into_inner).0.ends
    }

    /// Waits for an order, or for so long. Returns the latest order; `None` at the end.
    fn wait(&self, longest: Duration) -> Option<Told> {
        let content = self.content();
        let waited = self.changed.wait_timeout_while(content, longest, |it| !it.is_new && !it.ends);
        let (mut content, _) = waited.unwrap_or_else(PoisonError::into_inner);
        content.is_new = false;
        (!content.ends).then(|| content.told.clone())
    }
}

impl ServoPort {
    /// Starts the thread.
    ///
    /// # Errors
    /// The system has no thread left.
    pub(crate) fn start(with: Use) -> io::Result<Self> {
        let mailbox = Arc::new(Mailbox::default());
        let of_thread = Arc::clone(&mailbox);
        let work = move || {
            let _panic_ends_service = PanicEndsService;
            serve(&with, &of_thread);
        };
        let thread = thread::Builder::new().name("servos".into()).spawn(work)?;
        Ok(Self { mailbox, thread: Some(thread) })
    }
}

impl fmt::Debug for ServoPort {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("ServoPort")
    }
}

impl Drop for ServoPort {
    fn drop(&mut self) {
        self.mailbox.content().ends = true;
        self.mailbox.changed.notify_all();
        // The thread ends within an exchange, or after the handshake.
        let _ = self.thread.take().map(JoinHandle::join);
    }
}

impl Port for ServoPort {
    fn drain(&mut self, take: &mut dyn FnMut(Report<'_>)) -> Result<(), PortError> {
        let heard = std::mem::take(&mut self.mailbox.content().heard);
        heard.into_iter().for_each(|heard| take(heard.into_report()));
        Ok(())
    }

    fn send(&mut self, order: &Order<'_>) -> Result<(), PortError> {
        if let Some(told) = Told::of(order) {
            let mut content = self.mailbox.content();
            (content.told, content.is_new) = (told, true);
            self.mailbox.changed.notify_all();
        }
        Ok(())
    }
}

/// Opens the port again and again, until the end.
fn serve(with: &Use, mailbox: &Mailbox) {
    loop {
        let Ended(reason) = match use_port(with, mailbox) {
            Ok(()) => return,
            Err(ended) => ended,
        };
        mailbox.put(Heard::Unusable(format!("{}: {reason}", with.port.display())));
        if mailbox.ends_within(REOPEN_EVERY) {
            return;
        }
        // What was ordered before is over.
        mailbox.content().told = Told::default();
    }
}

/// Uses the port until the end.
fn use_port(with: &Use, mailbox: &Mailbox) -> Result<(), Ended> {
    let line =
        SerialLine::open(&with.port, with.baud).map_err(|problem| Ended(problem.to_string()))?;
    let mut session = Session::begin(line, with.layout.clone(), with.limits.clone())?;
    while let Some(told) = mailbox.wait(PAUSE_MAX) {
        session.exchange(&told)?.into_iter().for_each(|heard| mailbox.put(heard));
    }
    Ok(())
}

/// Ends the process if its thread panics: the arm would wait for readings for ever.
struct PanicEndsService;

impl Drop for PanicEndsService {
    fn drop(&mut self) {
        if thread::panicking() {
            std::process::exit(Exit::Invariant as i32);
        }
    }
}
