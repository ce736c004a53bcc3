//! The thread that asks the model: the main loop never waits for it.

use std::io;
use std::time::Duration;

use crossbeam_channel::{Receiver, Sender, bounded};
use model_reader::Client;
use service::clock;
use service::worker_channel::DeviceSender;

use crate::io::{In, ModelAnswer, ModelRequest};
use crate::model_queue::PENDING_MAX;

/// Handle of the thread; it ends with the process, or when dropped and its request answered.
#[derive(Debug)]
pub(crate) struct ModelWorker {
    requests: Sender<ModelRequest>,
}

impl ModelWorker {
    /// Starts the thread, which answers into `inbox`.
    ///
    /// # Errors
    /// The operating system gives no thread.
    pub(crate) fn start(client: Client, inbox: DeviceSender<In<'static>>) -> io::Result<Self> {
        let (requests, waiting) = bounded(PENDING_MAX);
        let work = move || work(&client, &waiting, &inbox);
        std::thread::Builder::new().name("model".to_owned()).spawn(work)?;
        Ok(Self { requests })
    }

    /// Hands over a request, without waiting.
    ///
    /// # Errors
    /// The answer in its place: the thread is behind or has ended.
    pub(crate) fn submit(&self, request: ModelRequest) -> Result<(), ModelAnswer> {
        self.requests.try_send(request).map_err(|error| {
            let reason = match error.is_full() {
                true => "too many requests are waiting",
                false => "the thread of the model has ended",
            };
            let ticket = error.into_inner().ticket;
            ModelAnswer { ticket, content: Err(reason.to_owned()) }
        })
    }
}

fn work(client: &Client, waiting: &Receiver<ModelRequest>, inbox: &DeviceSender<In<'static>>) {
    for ModelRequest { ticket, due, utterance } in waiting {
        let now = clock::now();
        // The reducer does without an answer that is late.
        if now >= due {
            continue;
        }
        let within = Duration::from_nanos(due.since(now).0);
        let content = client.ask(&utterance, within);
        if !inbox.send(In::Answer(ModelAnswer { ticket, content })) {
            return;
        }
    }
}
