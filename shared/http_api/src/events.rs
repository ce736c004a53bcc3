//! Events for programs: numbered, kept for those who come back, and stored for the console's next incarnation.
//!
//! A number is `STREAM-N`. The stream's name is random, and changes where the stored events are lost; who comes back with
//! another name, or from too long ago, is told so by the event `gap` and gets the whole state.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use safe_files::{read_private, replace_private};
use serde::{Deserialize, Serialize};
use serde_json::json;
use service::console_link::random_secret;
use tokio::sync::watch;

use crate::state::{State, Word};

/// Events that are kept.
const EVENTS_MAX: usize = 256;

/// One event.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Event {
    pub(crate) number: u64,
    pub(crate) name: String,
    /// One line of JSON.
    pub(crate) data: String,
}

/// What the latest events were about.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Seen {
    state: Word,
    why: Option<String>,
    prompt: u64,
    text: String,
    /// The interaction that ended last.
    ended: u64,
}

impl Seen {
    fn of(state: &State) -> Self {
        Self {
            state: state.state,
            why: state.why.clone(),
            prompt: state.prompt,
            text: state.text.clone(),
            ended: state.ended.as_ref().map_or(0, |ended| ended.interaction),
        }
    }
}

/// The kept events, as they are stored.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct Kept {
    stream: String,
    /// Number of the latest event.
    number: u64,
    events: VecDeque<Event>,
    /// None before the first known state.
    seen: Option<Seen>,
}

/// The events and the state, for the main loop to set and the server to read.
#[derive(Debug)]
pub(crate) struct Events {
    file: PathBuf,
    kept: Mutex<Kept>,
    state: watch::Sender<Arc<State>>,
}

/// What a client is sent next.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Next {
    /// The events after the one that it has.
    Events(Vec<Event>),
    /// What it has is not continued here: it needs the whole state, which holds up to this number.
    Gap(u64),
}

impl Events {
    /// Reads the events of the console's previous incarnation in the group's folder `run`.
    pub(crate) fn open(run: &Path) -> Self {
        let file = run.join("http.events");
        let stored = serde_json::from_str(&read_private(&file).unwrap_or_default());
        let kept: Kept = stored.unwrap_or_else(|_| Kept {
            // Without random numbers nobody comes back with this name, which is never asked for.
            stream: random_secret().unwrap_or_default().chars().take(8).collect(),
            ..Kept::default()
        });
        Self { file, kept: Mutex::new(kept), state: watch::Sender::new(Arc::default()) }
    }

    /// Returns the newest state, and a receiver that changes with it.
    pub(crate) fn watch(&self) -> watch::Receiver<Arc<State>> {
        self.state.subscribe()
    }

    pub(crate) fn state(&self) -> Arc<State> {
        Arc::clone(&self.state.borrow())
    }

    /// Publishes a state, with the events that lead to it.
    pub(crate) fn publish(&self, state: State) {
        let mut kept = self.kept();
        // A console that has just started knows nothing yet: that is not news about the robot.
        let is_news = state.inner.is_known || self.state.borrow().inner.is_known;
        if is_news && kept.take(&state) {
            self.store(&kept);
        }
        drop(kept);
        self.state.send_replace(Arc::new(state));
    }

    fn store(&self, kept: &Kept) {
        let text = serde_json::to_string(kept).unwrap_or_default();
        if let Err(error) = replace_private(&self.file, text) {
            tracing::debug!(%error, "the events are not stored");
        }
    }

    /// Returns the identifier of an event.
    pub(crate) fn id(&self, number: u64) -> String {
        format!("{}-{number}", self.kept().stream)
    }

    /// Returns the number of an identifier that a client has; `None` if it is of another stream, or nonsense.
    pub(crate) fn number(&self, id: &str) -> Option<u64> {
        let (stream, number) = id.rsplit_once('-')?;
        let kept = self.kept();
        let number = number.parse().ok().filter(|number| *number <= kept.number)?;
        (stream == kept.stream).then_some(number)
    }

    /// Returns what comes after an event, none for the beginning.
    pub(crate) fn after(&self, number: Option<u64>) -> Next {
        let kept = self.kept();
        let first = kept.events.front().map_or(kept.number + 1, |event| event.number);
        match number {
            Some(number) if number + 1 >= first => {
                let later = kept.events.iter().filter(|event| event.number > number);
                Next::Events(later.cloned().collect())
            }
            _ => Next::Gap(kept.number),
        }
    }

    fn kept(&self) -> MutexGuard<'_, Kept> {
        // Each event is added in one step.
        self.kept.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Kept {
    /// Adds the events that lead from the state seen last to this one. Returns whether anything is to be stored.
    fn take(&mut self, state: &State) -> bool {
        let now = Seen::of(state);
        if self.seen.as_ref() == Some(&now) {
            return false;
        }
        let Some(before) = self.seen.replace(now.clone()) else { return true };
        if (now.state, &now.why) != (before.state, &before.why) {
            self.add("state", json!({ "state": now.state, "why": now.why }));
        }
        let is_news = (now.prompt, &now.text) != (before.prompt, &before.text);
        if is_news && state.expects_answer {
            let State { interaction, prompt, text, question, options, .. } = state;
            self.add(
                "question",
                json!({ "interaction": interaction, "prompt": prompt, "text": text,
                        "question": question, "options": options }),
            );
        } else if is_news && !state.text.is_empty() {
            let State { interaction, prompt, text, .. } = state;
            self.add("line", json!({ "interaction": interaction, "prompt": prompt, "text": text }));
        }
        if let Some(ended) = state.ended.as_ref().filter(|_| now.ended != before.ended) {
            self.add("ended", json!(ended));
        }
        true
    }

    fn add(&mut self, name: &str, data: serde_json::Value) {
        self.number += 1;
        if self.events.len() == EVENTS_MAX {
            self.events.pop_front();
        }
        let (number, data) = (self.number, data.to_string());
        self.events.push_back(Event { number, name: name.to_owned(), data });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn state(word: Word, prompt: u64, text: &str) -> State {
        let mut state = State { state: word, prompt, text: text.to_owned(), ..State::default() };
        state.inner.is_known = true;
        state
    }

    fn names(next: &Next) -> Vec<&str> {
        let Next::Events(events) = next else { panic!("{next:?}") };
        events.iter().map(|event| event.name.as_str()).collect()
    }

    #[test]
    fn events_tell_what_has_changed_once() {
        let run = tempfile::tempdir().unwrap();
        let events = Events::open(run.path());
        events.publish(State::default());
        events.publish(state(Word::Idle, 0, ""));
        assert_eq!(events.after(None), Next::Gap(0));
        let asks = State { expects_answer: true, ..state(Word::Asking, 1, "Is it white?") };
        events.publish(asks.clone());
        events.publish(asks);
        events.publish(state(Word::Fetching, 2, "I will get the white bowl."));
        let after = events.after(Some(0));
        assert_eq!(names(&after), ["state", "question", "state", "line"]);
        assert_eq!(names(&events.after(Some(2))), ["state", "line"]);
        assert_eq!(events.after(Some(4)), Next::Events(Vec::new()));
    }

    #[test]
    fn events_go_on_in_the_next_incarnation() {
        let run = tempfile::tempdir().unwrap();
        let events = Events::open(run.path());
        events.publish(state(Word::Idle, 0, ""));
        events.publish(state(Word::Asking, 1, "Is it white?"));
        let id = events.id(1);
        drop(events);
        let events = Events::open(run.path());
        // It knows nothing at first.
        events.publish(State::default());
        events.publish(state(Word::Stopped, 1, "Is it white?"));
        assert_eq!(events.number(&id), Some(1));
        assert_eq!(names(&events.after(Some(1))), ["line", "state"]);
        for other in ["", "1", "-", "other-1", &events.id(4), &format!("{id}1"), "-1"] {
            assert_eq!(events.number(other), None, "{other}");
        }
    }

    #[test]
    fn events_are_bounded_and_a_gap_is_said() {
        let run = tempfile::tempdir().unwrap();
        let events = Events::open(run.path());
        for prompt in 0..=EVENTS_MAX as u64 + 1 {
            events.publish(state(Word::Idle, prompt, "All right."));
        }
        let number = EVENTS_MAX as u64 + 1;
        assert_eq!(events.after(Some(0)), Next::Gap(number));
        let Next::Events(all) = events.after(Some(1)) else { panic!("a gap") };
        assert_eq!((all.len(), all[0].number), (EVENTS_MAX, 2));
    }
}
