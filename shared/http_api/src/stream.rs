//! `events`: server-sent events, from where a client has left off.

use std::collections::VecDeque;
use std::convert::Infallible;
use std::sync::Arc;
use std::time::Duration;

use axum::http::{HeaderMap, HeaderName, header};
use axum::response::sse::{Event as Frame, KeepAlive, Sse};
use axum::response::{IntoResponse, Response};
use futures_util::stream;
use tokio::sync::watch;
use tokio::time::sleep;

use crate::api::{Api, Caller};
use crate::events::Next;
use crate::limits::Place;
use crate::problem::Problem;
use crate::state::State;

/// Interval of the comments that keep a silent stream open.
const ALIVE_EVERY: Duration = Duration::from_secs(15);
/// Interval at which the token of a silent stream is checked.
const CHECK_EVERY: Duration = Duration::from_secs(2);
/// The latest event that a client has.
const LAST_EVENT_ID: HeaderName = HeaderName::from_static("last-event-id");

/// One client's stream.
struct Stream {
    api: Arc<Api>,
    caller: Caller,
    /// The latest event that it was given; none before the whole state.
    cursor: Option<u64>,
    /// It was there before.
    is_back: bool,
    queue: VecDeque<Frame>,
    states: watch::Receiver<Arc<State>>,
    ending: watch::Receiver<bool>,
    _place: Place,
}

/// Serves the events to a client that has a right to them.
pub(crate) fn serve(
    api: Arc<Api>,
    caller: Caller,
    headers: &HeaderMap,
) -> Result<Response, Problem> {
    let place = api.streams.take(&caller.name).ok_or_else(|| Problem::too_many("event streams"))?;
    let last = headers.get(LAST_EVENT_ID).and_then(|id| id.to_str().ok());
    let first = Stream {
        cursor: last.and_then(|id| api.events.number(id)),
        is_back: last.is_some(),
        queue: VecDeque::new(),
        states: api.events.watch(),
        ending: api.rules.ending.clone(),
        caller,
        api,
        _place: place,
    };
    let frames = stream::unfold(first, |mut stream| async move {
        let frame = stream.next().await?;
        Some((Ok::<_, Infallible>(frame), stream))
    });
    let alive = KeepAlive::new().interval(ALIVE_EVERY);
    // Its connection, which no silence ends, ends with it.
    let close = [(header::CONNECTION, "close")];
    Ok((close, Sse::new(frames).keep_alive(alive)).into_response())
}

impl Stream {
    /// Returns the next frame; none at the end.
    async fn next(&mut self) -> Option<Frame> {
        loop {
            if let Some(frame) = self.queue.pop_front() {
                return Some(frame);
            }
            if *self.ending.borrow() || !self.api.lasts(&self.caller) {
                return None;
            }
            // Before the events are read: what changes meanwhile is noticed.
            self.states.mark_unchanged();
            self.read();
            if self.queue.is_empty() {
                tokio::select! {
                    _ = self.states.changed() => {}
                    _ = self.ending.changed() => {}
                    () = sleep(CHECK_EVERY) => {}
                }
            }
        }
    }

    fn read(&mut self) {
        let events = &self.api.events;
        match events.after(self.cursor) {
            Next::Events(new) => {
                self.cursor = new.last().map(|event| event.number).or(self.cursor);
                let frame = |(id, name, data): (String, String, String)| {
                    Frame::default().id(id).event(name).data(data)
                };
                let new = new.into_iter().map(|it| (events.id(it.number), it.name, it.data));
                self.queue.extend(new.map(frame));
            }
            Next::Gap(number) => {
                let id = events.id(number);
                if std::mem::replace(&mut self.is_back, true) {
                    self.queue.push_back(Frame::default().id(&id).event("gap").data("{}"));
                }
                // Every state can be written.
                let state = serde_json::to_string(&*events.state()).unwrap_or_default();
                self.queue.push_back(Frame::default().id(id).event("snapshot").data(state));
                self.cursor = Some(number);
            }
        }
    }
}
