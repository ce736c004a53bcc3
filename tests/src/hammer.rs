//! A client that asks for far more than the robot can answer.

use crate::Group;
use messages::{ClientId, Injection, Sound, topics};
use service::client::{Client, request_key};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::thread::JoinHandle;
use std::time::Duration;

/// Pause between two requests, whose answers it does not wait for: 2,000 a second are 15 times what a
/// group takes in.
const PAUSE: Duration = Duration::from_micros(500);
/// [`Hammer::sent`] of one that is to end.
const ENDS: u64 = u64::MAX;

/// A client that submits requests all the time, until it is dropped.
#[derive(Debug)]
pub struct Hammer {
    sent: Arc<AtomicU64>,
    thread: Option<JoinHandle<()>>,
}

impl Hammer {
    /// Has a client of `group` submit `text` all the time.
    pub fn start(group: &Group, text: &str) -> Self {
        let (paths, text) = (group.paths().clone(), text.to_owned());
        let sent = Arc::new(AtomicU64::new(0));
        let count = Arc::clone(&sent);
        let work = move || {
            let client = Client::join(&paths).expect("a running group");
            let writer = client.bus().encoded_writer::<Injection>(&topics::INJECTION);
            let writer = writer.expect("injections");
            let id = ClientId(0x4841_4d4d_4552);
            while count.load(Ordering::Relaxed) != ENDS {
                let (key, sound) = (request_key(id), Sound::Text(text.clone()));
                let injection = Injection { key, onset_ns: 0, end_ns: 0, seen_prompt: 0, sound };
                writer.send(&injection).expect("shared memory");
                let next = |sent: u64| (sent != ENDS).then_some(sent + 1);
                let _ = count.fetch_update(Ordering::Relaxed, Ordering::Relaxed, next);
                std::thread::sleep(PAUSE);
            }
        };
        Self { sent, thread: Some(std::thread::spawn(work)) }
    }

    /// Returns how many requests it has submitted.
    pub fn sent(&self) -> u64 {
        self.sent.load(Ordering::Relaxed)
    }
}

impl Drop for Hammer {
    fn drop(&mut self) {
        self.sent.store(ENDS, Ordering::Relaxed);
        let ended = self.thread.take().map(JoinHandle::join);
        if !std::thread::panicking() {
            assert!(!matches!(ended, Some(Err(_))), "the client that hammers has failed");
        }
    }
}
