//! A line that says what a verb is at, on a terminal's standard error and nowhere else.

use std::io::{self, IsTerminal, Write};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use command_line::output::Output;
use service::printable::one_line;
use signal_hook::consts::SIGINT;
use signal_hook::{flag, low_level};

/// Verbs that end sooner show no line.
const PATIENCE: Duration = Duration::from_secs(1);
/// Time between two looks at the line, and at Ctrl-C.
const LOOK_EVERY: Duration = Duration::from_millis(50);

/// Progress of a verb, shown by a thread of its own, however long a step takes. Ctrl-C ends the program as without it,
/// but erases the line first.
pub(crate) struct Progress {
    shown: Arc<Shown>,
    thread: Option<JoinHandle<()>>,
}

#[derive(Default)]
struct Shown {
    line: Mutex<String>,
    /// From then on Ctrl-C ends the program by itself.
    is_over: Arc<AtomicBool>,
    is_interrupted: Arc<AtomicBool>,
}

impl Progress {
    /// A verb begins; with `--json` its progress is not shown.
    pub(crate) fn start(out: &Output<'_>) -> Self {
        let shown = Arc::<Shown>::default();
        let is_shown = !out.is_json() && io::stderr().is_terminal();
        let thread = is_shown.then(|| Arc::clone(&shown).start()).and_then(Result::ok);
        Self { shown, thread }
    }

    /// Sets the line.
    pub(crate) fn at(&self, line: String) {
        *self.shown.line.lock().unwrap_or_else(PoisonError::into_inner) = line;
    }
}

impl Drop for Progress {
    /// Erases the line.
    fn drop(&mut self) {
        self.shown.is_over.store(true, Ordering::SeqCst);
        if let Some(thread) = self.thread.take() {
            thread.thread().unpark();
            let _ = thread.join();
        }
    }
}

impl Shown {
    fn start(self: Arc<Self>) -> io::Result<JoinHandle<()>> {
        flag::register_conditional_default(SIGINT, Arc::clone(&self.is_over))?;
        flag::register(SIGINT, Arc::clone(&self.is_interrupted))?;
        let began = Instant::now();
        thread::Builder::new().name("progress".into()).spawn(move || self.follow(began))
    }

    fn follow(&self, began: Instant) {
        let mut drawn = String::new();
        while !self.is_over.load(Ordering::SeqCst) && !self.is_interrupted.load(Ordering::SeqCst) {
            let line = self.line.lock().unwrap_or_else(PoisonError::into_inner).clone();
            if began.elapsed() >= PATIENCE && line != drawn {
                draw(&one_line(&line));
                drawn = line;
            }
            thread::park_timeout(LOOK_EVERY);
        }
        if !drawn.is_empty() {
            draw("");
        }
        if self.is_interrupted.load(Ordering::SeqCst) {
            let _ = low_level::emulate_default_handler(SIGINT);
        }
    }
}

/// Replaces the line on the terminal.
pub(crate) fn draw(text: &str) {
    // A closed standard error is not an error here.
    let _ = write!(io::stderr(), "\r\x1b[K{text}").and_then(|()| io::stderr().flush());
}
