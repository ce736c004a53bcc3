//! A client that asks for far more than the robot can answer.

use crate::Group;
use messages::{ClientId, Injection, Sound, topics};
use service::client::{Client, request_key};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread::JoinHandle;
use std::time::Duration;

/// Pause between two requests, whose answers it does not wait for: 2,000 a second are 15 times what a
/// group takes in.
const PAUSE: Duration = Duration::from_micros(500);

/// A client that submits requests all the time, until it is dropped.
#[derive(Debug)]
pub struct Hammer {
    progress: Arc<Progress>,
    thread: Option<JoinHandle<()>>,
}

#[derive(Debug, Default)]
struct Progress {
    sent: AtomicU64,
    is_ending: AtomicBool,
}

impl Hammer {
    /// Has a client of `group` submit `text` all the time.
    pub fn start(group: &Group, text: &str) -> Self {
        let (paths, text) = (group.paths().clone(), text.to_owned());
        let progress = Arc::new(Progress::default());
        let own = Arc::clone(&progress);
        let work = move || {
            let client = Client::join(&paths).expect("a running group");
            let writer = client.bus().encoded_writer::<Injection>(&topics::INJECTION);
            let writer = writer.expect("injections");
            let id = ClientId(0x4841_4d4d_4552);
            while !own.is_ending.load(Ordering::Relaxed) {
                let (key, sound) = (request_key(id), Sound::Text(text.clone()));
                let injection = Injection::new(key, sound);
                writer.send(&injection).expect("shared memory");
                own.sent.fetch_add(1, Ordering::Relaxed);
                std::thread::sleep(PAUSE);
            }
        };
        Self { progress, thread: Some(std::thread::spawn(work)) }
    }

    /// Returns how many requests it has submitted.
    pub fn sent(&self) -> u64 {
        self.progress.sent.load(Ordering::Relaxed)
    }
}

impl Drop for Hammer {
    fn drop(&mut self) {
        self.progress.is_ending.store(true, Ordering::Relaxed);
        let ended = self.thread.take().map(JoinHandle::join);
        if !std::thread::panicking() {
            assert!(!matches!(ended, Some(Err(_))), "the client that hammers has failed");
        }
    }
}
