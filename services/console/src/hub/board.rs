//! What everybody may see, as text, each part with the revision of its last change.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use tokio::sync::watch;

/// Lines of the transcript that are kept.
pub const LINES_MAX: usize = 200;
/// Utterances being spoken at a time that are shown.
const PARTIALS_MAX: usize = 8;

/// The newest text of everything, bounded whatever happens.
#[derive(Debug)]
pub struct Board {
    state: Mutex<State>,
    changed: watch::Sender<u64>,
}

#[derive(Debug, Default)]
struct State {
    revision: u64,
    sections: Vec<(&'static str, Item)>,
    joints: Option<Item>,
    partials: VecDeque<(String, Item)>,
    lines: VecDeque<(u64, Item)>,
}

#[derive(Clone, Debug)]
struct Item {
    revision: u64,
    text: Arc<str>,
}

/// How far a viewer has come.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cursor {
    revision: u64,
    /// Lines up to this one are known from an earlier connection.
    last_line: u64,
}

impl Cursor {
    /// A viewer who has seen nothing but the transcript up to a line.
    pub fn after_line(last_line: u64) -> Self {
        Self { revision: 0, last_line }
    }
}

impl Default for Board {
    fn default() -> Self {
        Self { state: Mutex::default(), changed: watch::Sender::new(0) }
    }
}

impl Board {
    /// Tells that something has changed.
    pub fn watch(&self) -> watch::Receiver<u64> {
        self.changed.subscribe()
    }

    /// Sets a section to a JSON value as text. Whether it is another than before.
    pub fn section(&self, name: &'static str, text: &str) -> bool {
        let mut state = self.state();
        let next = state.revision + 1;
        let item = Item { revision: next, text: text.into() };
        match state.sections.iter_mut().find(|(known, _)| *known == name) {
            Some((_, before)) if *before.text == *text => return false,
            Some((_, before)) => *before = item,
            None => state.sections.push((name, item)),
        }
        self.tell(&mut state);
        true
    }

    /// Sets the joints' frame.
    pub fn joints(&self, frame: String) {
        let mut state = self.state();
        state.joints = Some(Item { revision: state.revision + 1, text: frame.into() });
        self.tell(&mut state);
    }

    /// Sets the frame of what is being said in one stream.
    pub fn partial(&self, stream: &str, frame: String) {
        let mut state = self.state();
        state.partials.retain(|(known, _)| known != stream);
        if state.partials.len() == PARTIALS_MAX {
            state.partials.pop_front();
        }
        let item = Item { revision: state.revision + 1, text: frame.into() };
        state.partials.push_back((stream.to_owned(), item));
        self.tell(&mut state);
    }

    /// Adds a line to the transcript, or replaces the one of that number.
    pub fn line(&self, id: u64, text: &str) {
        let mut state = self.state();
        let item = Item { revision: state.revision + 1, text: text.into() };
        match state.lines.iter_mut().find(|(known, _)| *known == id) {
            Some((_, before)) => *before = item,
            None => {
                if state.lines.len() == LINES_MAX {
                    state.lines.pop_front();
                }
                state.lines.push_back((id, item));
            }
        }
        self.tell(&mut state);
    }

    /// Number of the first line that is kept, 0 where there is none.
    pub fn first_line(&self) -> u64 {
        self.state().lines.front().map_or(0, |(id, _)| *id)
    }

    /// The frames that bring a viewer up to date.
    pub fn news(&self, cursor: &mut Cursor) -> Vec<String> {
        let state = self.state();
        let since = cursor.revision;
        let is_new = |item: &Item| item.revision > since;
        let mut frames = Vec::new();
        let parts = state.sections.iter().filter(|(_, item)| is_new(item));
        let parts: Vec<String> =
            parts.map(|(name, item)| format!("\"{name}\":{}", item.text)).collect();
        if !parts.is_empty() {
            frames.push(format!("{{\"t\":\"state\",\"parts\":{{{}}}}}", parts.join(",")));
        }
        let first = since == 0;
        let lines = state.lines.iter().filter(|(_, item)| is_new(item));
        let lines = lines.filter(|(id, _)| !first || *id > cursor.last_line);
        let lines: Vec<&str> = lines.map(|(_, item)| &*item.text).collect();
        if !lines.is_empty() {
            frames.push(format!("{{\"t\":\"lines\",\"lines\":[{}]}}", lines.join(",")));
        }
        let partials = state.partials.iter().map(|(_, item)| item);
        let rest = partials.chain(&state.joints).filter(|item| is_new(item));
        frames.extend(rest.map(|item| item.text.to_string()));
        cursor.revision = state.revision;
        frames
    }

    /// Every section as one JSON object, and the transcript.
    pub fn all(&self) -> String {
        let state = self.state();
        let parts = state.sections.iter().map(|(name, item)| format!("\"{name}\":{}", item.text));
        let parts: Vec<String> = parts.collect();
        let lines: Vec<&str> = state.lines.iter().map(|(_, item)| &*item.text).collect();
        let comma = if parts.is_empty() { "" } else { "," };
        format!("{{{}{comma}\"lines\":[{}]}}", parts.join(","), lines.join(","))
    }

    fn tell(&self, state: &mut State) {
        state.revision += 1;
        self.changed.send_replace(state.revision);
    }

    fn state(&self) -> MutexGuard<'_, State> {
        // Every change is one assignment: what a panic has left behind is whole.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_viewer_gets_everything_once_and_then_what_changed() {
        let board = Board::default();
        assert!(board.section("arm", "1") && board.section("turn", "2"));
        board.line(7, "{}");
        let mut cursor = Cursor::default();
        assert_eq!(
            board.news(&mut cursor),
            [r#"{"t":"state","parts":{"arm":1,"turn":2}}"#, r#"{"t":"lines","lines":[{}]}"#]
        );
        assert!(board.news(&mut cursor).is_empty());
        assert!(!board.section("arm", "1"), "the same again is no news");
        assert!(board.section("arm", "3") && board.section("arm", "4"));
        assert_eq!(board.news(&mut cursor), [r#"{"t":"state","parts":{"arm":4}}"#]);
    }

    #[test]
    fn lines_go_on_where_a_viewer_was_and_replace_each_other() {
        let board = Board::default();
        (1..=300).for_each(|id| board.line(id, &id.to_string()));
        assert_eq!(board.first_line(), 101);
        let mut cursor = Cursor::after_line(298);
        assert_eq!(board.news(&mut cursor), [r#"{"t":"lines","lines":[299,300]}"#]);
        board.line(299, "0");
        assert_eq!(board.news(&mut cursor), [r#"{"t":"lines","lines":[0]}"#]);
    }

    #[test]
    fn partials_of_one_stream_replace_each_other() {
        let board = Board::default();
        let mut cursor = Cursor::default();
        for stream in ["a", "b", "a"] {
            board.partial(stream, format!("{stream}!"));
        }
        assert_eq!(board.news(&mut cursor), ["b!", "a!"]);
        (0..20).for_each(|n| board.partial(&n.to_string(), n.to_string()));
        assert_eq!(board.news(&mut cursor).len(), PARTIALS_MAX);
    }

    #[test]
    fn all_is_one_object() {
        let board = Board::default();
        assert_eq!(board.all(), r#"{"lines":[]}"#);
        board.section("arm", "1");
        assert_eq!(board.all(), r#"{"arm":1,"lines":[]}"#);
    }
}
