//! Bounds of a process with a DDS implementation, and the watch over its threads.

use rustix::process::{Resource, Rlimit, setrlimit};
use service::exit::{Exit, Failure};
use service::{Span, Time};
use std::fs;

/// Beginning of the threads' names.
const NAME: &str = "RustDDS";
/// Interval at which they are counted.
const COUNT_EVERY: Span = Span::from_ms(250);
/// Most memory of the process, bytes. The DDS implementation believes what a peer says of the length of its message,
/// and of the number of peers; beyond this the process ends, and the supervisor starts it again.
const MEMORY_MAX: u64 = 512 << 20;

/// Limits the memory of this process.
pub(crate) fn limit_memory() -> Result<(), Failure> {
    let most = Rlimit { current: Some(MEMORY_MAX), maximum: Some(MEMORY_MAX) };
    setrlimit(Resource::Data, most).map_err(|error| {
        Failure::new(Exit::NotReached, format!("limit of the process's memory: {error}"))
    })
}

/// Watch over the threads of the DDS implementation. They end, and say nothing, when a wait of theirs is
/// interrupted: by a stop and continuation of the process, a suspension of the machine, a debugger.
/// Publishing succeeds all the same afterwards, and reaches no subscriber.
#[derive(Debug)]
pub(crate) struct ThreadWatch {
    most: usize,
    counted: Time,
}

impl ThreadWatch {
    /// Begins the watch of a process that has joined a domain.
    pub(crate) fn begin(now: Time) -> Self {
        Self { most: running(), counted: now }
    }

    /// Counts the threads when it is time.
    ///
    /// # Errors
    /// One has ended.
    pub(crate) fn count(&mut self, now: Time) -> Result<(), Failure> {
        if now < self.counted + COUNT_EVERY {
            return Ok(());
        }
        self.counted = now;
        let running = running();
        self.most = self.most.max(running);
        if running == self.most {
            return Ok(());
        }
        let what = format!(
            "{running} of {} DDS threads run: one has ended, as after a stop of the process or a \
             suspension of the machine; restarting",
            self.most
        );
        Err(Failure::new(Exit::NotReached, what))
    }
}

/// Returns how many of them run.
fn running() -> usize {
    let tasks = fs::read_dir("/proc/self/task").into_iter().flatten().flatten();
    let names = tasks.filter_map(|task| fs::read_to_string(task.path().join("comm")).ok());
    names.filter(|name| name.starts_with(NAME)).count()
}
