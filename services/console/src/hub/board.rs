//! The board: the newest state for viewers, as text, each part with the revision of its change.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use service::bounded::push_bounded;
use tokio::sync::watch;

/// Most lines of the transcript.
pub const LINES_MAX: usize = 200;
/// Most interim texts at a time.
const PARTIALS_MAX: usize = 8;

/// The newest text of every part; bounded.
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

/// The state that a viewer has.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cursor {
    revision: u64,
    /// Lines up to this one are known from an earlier connection.
    last_line: u64,
}

impl Cursor {
    /// Makes the cursor of a viewer that has the transcript up to a line.
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
    /// Returns a receiver that changes with the board.
    pub fn watch(&self) -> watch::Receiver<u64> {
        self.changed.subscribe()
    }

    /// Sets a section to JSON text; returns whether it has changed.
    pub fn section(&self, name: &'static str, text: &str) -> bool {
        let mut state = self.state();
        let next = state.revision + 1;
        let item = Item { revision: next, text: text.into() };
        match state.sections.iter_mut().find(|(known, _)| *known == name) {
            Some((_, before)) if *before.text == *text => return false,
            Some((_, before)) => *before = item,
            None => state.sections.push((name, item)),
        }
        self.publish(&mut state);
        true
    }

    pub fn joints(&self, frame: String) {
        let mut state = self.state();
        state.joints = Some(Item { revision: state.revision + 1, text: frame.into() });
        self.publish(&mut state);
    }

    /// Sets the frame with the interim text of one stream.
    pub fn partial(&self, stream: &str, frame: String) {
        let mut state = self.state();
        state.partials.retain(|(known, _)| known != stream);
        let item = Item { revision: state.revision + 1, text: frame.into() };
        push_bounded(&mut state.partials, PARTIALS_MAX, (stream.to_owned(), item));
        self.publish(&mut state);
    }

    /// Adds a line to the transcript, or replaces the one of that number.
    pub fn line(&self, id: u64, text: &str) {
        let mut state = self.state();
        let item = Item { revision: state.revision + 1, text: text.into() };
        match state.lines.iter_mut().find(|(known, _)| *known == id) {
            Some((_, before)) => *before = item,
            None => push_bounded(&mut state.lines, LINES_MAX, (id, item)),
        }
        self.publish(&mut state);
    }

    /// Returns the number of the first line, 0 for none.
    pub fn first_line(&self) -> u64 {
        self.state().lines.front().map_or(0, |(id, _)| *id)
    }

    /// Returns the frames that bring a viewer up to date.
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

    /// Returns every section and the transcript as one JSON object.
    pub fn all(&self) -> String {
        let state = self.state();
        let parts = state.sections.iter().map(|(name, item)| format!("\"{name}\":{}", item.text));
        let parts: Vec<String> = parts.collect();
        let lines: Vec<&str> = state.lines.iter().map(|(_, item)| &*item.text).collect();
        let comma = if parts.is_empty() { "" } else { "," };
        format!("{{{}{comma}\"lines\":[{}]}}", parts.join(","), lines.join(","))
    }

    fn publish(&self, state: &mut State) {
        state.revision += 1;
        self.changed.send_replace(state.revision);
    }

    fn state(&self) -> MutexGuard<'_, State> {
        // Every change is one assignment, so that a panic leaves a consistent state.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn board_sends_everything_once_and_then_changes() {
        let board = Board::default();
        assert!(board.section("arm", "1") && board.section("turn", "2"));
        board.line(7, "{}");
        let mut cursor = Cursor::default();
        assert_eq!(
            board.news(&mut cursor),
            [r#"{"t":"state","parts":{"arm":1,"turn":2}}"#, r#"{"t":"lines","lines":[{}]}"#]
        );
        assert!(board.news(&mut cursor).is_empty());
        assert!(!board.section("arm", "1"), "an equal section is not published");
        assert!(board.section("arm", "3") && board.section("arm", "4"));
        assert_eq!(board.news(&mut cursor), [r#"{"t":"state","parts":{"arm":4}}"#]);
    }

    #[test]
    fn board_lines_continue_after_the_viewers_last_line() {
        let board = Board::default();
        (1..=300).for_each(|id| board.line(id, &id.to_string()));
        assert_eq!(board.first_line(), 101);
        let mut cursor = Cursor::after_line(298);
        assert_eq!(board.news(&mut cursor), [r#"{"t":"lines","lines":[299,300]}"#]);
        board.line(299, "0");
        assert_eq!(board.news(&mut cursor), [r#"{"t":"lines","lines":[0]}"#]);
    }

    #[test]
    fn board_keeps_the_newest_interim_text_of_a_stream() {
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
    fn board_state_is_one_object() {
        let board = Board::default();
        assert_eq!(board.all(), r#"{"lines":[]}"#);
        board.section("arm", "1");
        assert_eq!(board.all(), r#"{"arm":1,"lines":[]}"#);
    }
}
