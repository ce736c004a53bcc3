//! Keys of the dashboard.
//!
//! A terminal reports no release of a key, so that a key cannot be held to resume. Stop keys only ever stop; resuming
//! is another key and then a typed word, and both are dead for a while after every stop key.

use messages::StopId;
use ratatui::crossterm::event::{KeyCode, KeyEvent, KeyEventKind, KeyModifiers};
use service::Time;

use crate::verbs::motion::ResumeGuard;

/// Most characters of a line that is typed.
const CHARS_MAX: usize = 500;
/// The word that releases the motion stop.
const RESUME: &str = "resume";

/// What the user asks for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Command {
    /// End the dashboard.
    Quit,
    /// Latch the motion stop.
    Stop,
    /// Release the motion stop that was in force when the release was begun; 0 stands for any.
    Release(StopId),
    /// Say this to the robot.
    Say(String),
    /// The user wants to resume too soon after a stop.
    TooSoon,
}

/// What keys mean at the moment.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) enum Mode {
    /// Each key is a command.
    #[default]
    Watching,
    /// Keys are text for the robot, so far this.
    Typing(String),
    /// A release of the motion stop waits for its word, of which this has been typed.
    Releasing(String),
}

#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Keyboard {
    mode: Mode,
    guard: ResumeGuard,
    /// The stop in force when the release was begun that waits for its word.
    seen: StopId,
}

impl Keyboard {
    /// What keys mean at the moment.
    pub(super) fn mode(&self) -> &Mode {
        &self.mode
    }

    /// A keyboard in this mode.
    #[cfg(test)]
    pub(super) fn in_mode(mode: Mode) -> Self {
        Self { mode, ..Self::default() }
    }

    /// Takes a key, while `stop` is in force. Ctrl-S stops the arm and Ctrl-C quits, whatever the other keys mean.
    pub(super) fn press(&mut self, key: KeyEvent, stop: StopId, now: Time) -> Option<Command> {
        if key.kind == KeyEventKind::Release {
            return None;
        }
        // A stop that is given while its release is typed has not been seen: with none before, the
        // release would name none and lift it.
        if self.seen == StopId(0) && stop > StopId(0) && matches!(self.mode, Mode::Releasing(_)) {
            self.mode = Mode::Watching;
        }
        if !matches!(self.mode, Mode::Releasing(_)) {
            self.seen = stop;
        }
        if key.modifiers.contains(KeyModifiers::CONTROL) {
            return match key.code {
                KeyCode::Char('c') => Some(Command::Quit),
                KeyCode::Char('s') => Some(self.stop(now)),
                _ => None,
            };
        }
        match std::mem::take(&mut self.mode) {
            Mode::Watching => self.command(key.code, now),
            Mode::Typing(text) => self.typed(text, key.code),
            Mode::Releasing(word) => self.released(word, key.code, now),
        }
    }

    fn stop(&mut self, now: Time) -> Command {
        if let Mode::Releasing(_) = self.mode {
            self.mode = Mode::Watching;
        }
        self.guard.on_stop(now);
        Command::Stop
    }

    fn command(&mut self, code: KeyCode, now: Time) -> Option<Command> {
        match code {
            KeyCode::Char('q') => return Some(Command::Quit),
            KeyCode::Char('s' | 'S' | ' ') | KeyCode::Esc => return Some(self.stop(now)),
            KeyCode::Char('r') if !self.guard.may_resume(now) => return Some(Command::TooSoon),
            KeyCode::Char('r') => self.mode = Mode::Releasing(String::new()),
            KeyCode::Char('t') | KeyCode::Enter => self.mode = Mode::Typing(String::new()),
            _ => {}
        }
        None
    }

    /// Anything but the word gives the release up, and counts as the command that it is otherwise.
    fn released(&mut self, mut word: String, code: KeyCode, now: Time) -> Option<Command> {
        match code {
            KeyCode::Enter if word == RESUME => {
                return Some(match self.guard.may_resume(now) {
                    true => Command::Release(self.seen),
                    false => Command::TooSoon,
                });
            }
            KeyCode::Enter => return None,
            KeyCode::Backspace => drop(word.pop()),
            KeyCode::Char(c) if RESUME[word.len()..].starts_with(c) => word.push(c),
            KeyCode::Char('s' | 'S' | ' ') | KeyCode::Esc => return Some(self.stop(now)),
            _ => return None,
        }
        self.mode = Mode::Releasing(word);
        None
    }

    fn typed(&mut self, mut text: String, code: KeyCode) -> Option<Command> {
        match code {
            KeyCode::Esc => return None,
            KeyCode::Enter => {
                let words = text.trim();
                return (!words.is_empty()).then(|| Command::Say(words.to_owned()));
            }
            KeyCode::Backspace => drop(text.pop()),
            KeyCode::Char(c) if text.chars().count() < CHARS_MAX => text.push(c),
            _ => {}
        }
        self.mode = Mode::Typing(text);
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use service::Span;

    const STOP: Command = Command::Stop;
    const SEEN: StopId = StopId(7);
    const RELEASE: Command = Command::Release(SEEN);

    fn at(ms: u64) -> Time {
        Time(0) + Span::from_ms(ms)
    }

    fn control(c: char) -> KeyEvent {
        KeyEvent::new(KeyCode::Char(c), KeyModifiers::CONTROL)
    }

    fn key(c: char) -> KeyEvent {
        let code = match c {
            '\n' => KeyCode::Enter,
            '\x1b' => KeyCode::Esc,
            '\x08' => KeyCode::Backspace,
            '\x13' => return control('s'),
            c => KeyCode::Char(c),
        };
        KeyEvent::new(code, KeyModifiers::NONE)
    }

    fn press(keyboard: &mut Keyboard, keys: &str, ms: u64) -> Vec<Command> {
        keys.chars().filter_map(|c| keyboard.press(key(c), SEEN, at(ms))).collect()
    }

    #[test]
    fn dashboard_keys_are_commands_until_text_is_typed() {
        let mut keyboard = Keyboard::default();
        assert_eq!(press(&mut keyboard, "xsS \x1b", 0), [STOP, STOP, STOP, STOP]);
        let said = press(&mut keyboard, "tthe cupsx\x08\n", 0);
        assert_eq!(said, [Command::Say("the cups".to_owned())]);
        assert_eq!(press(&mut keyboard, "\nq \x1b", 0), []);
        assert_eq!(press(&mut keyboard, "t  \nq", 0), [Command::Quit]);
    }

    #[test]
    fn dashboard_releases_the_stop_only_by_a_key_and_a_word() {
        let mut keyboard = Keyboard::default();
        assert_eq!(press(&mut keyboard, "rresume\n", 0), [RELEASE]);
        assert_eq!(
            press(&mut keyboard, "rresx\x08ume\n", 0),
            [],
            "given up at the first wrong letter"
        );
        keyboard = Keyboard::default();
        assert_eq!(press(&mut keyboard, "rres\x08sume\n", 0), [RELEASE]);
        for wrong in ["r\n", "resume\n", "rresum\n", "rresumee\n", "rRESUME\n", "rr\nr\n"] {
            let commands = press(&mut Keyboard::default(), wrong, 0);
            assert!(!commands.contains(&RELEASE), "{wrong:?}: {commands:?}");
        }
        assert_eq!(press(&mut Keyboard::default(), "rre ", 0), [STOP]);
        assert_eq!(press(&mut Keyboard::default(), "rs", 0), [STOP]);
        let mut keyboard = Keyboard::default();
        assert_eq!(press(&mut keyboard, "rresume\x13\n", 0), [STOP], "and no release after it");
        keyboard = Keyboard::default();
        // Another stop is given while the word is typed.
        press(&mut keyboard, "rresume", 2_000);
        assert_eq!(keyboard.press(key('\n'), StopId(8), at(2_000)), Some(RELEASE));
        assert_eq!(keyboard.press(key('r'), StopId(8), at(2_000)), None);
        assert_eq!(press(&mut keyboard, "resume\n", 2_000), [Command::Release(StopId(8))]);
        // The same with none before: the release would be of any.
        for c in "rresum".chars() {
            assert_eq!(keyboard.press(key(c), StopId(0), at(2_000)), None);
        }
        for c in "e\n".chars() {
            assert_eq!(keyboard.press(key(c), StopId(9), at(2_000)), None);
        }
    }

    #[test]
    fn dashboard_resumes_two_seconds_after_the_latest_stop_key() {
        let mut keyboard = Keyboard::default();
        for ms in [0, 1_900, 3_800] {
            assert_eq!(press(&mut keyboard, "s", ms), [STOP]);
            assert_eq!(press(&mut keyboard, "r", ms + 1_899), [Command::TooSoon]);
        }
        assert_eq!(press(&mut keyboard, "rresume\n", 5_800), [RELEASE]);
        // A stop key while the word is typed.
        assert_eq!(press(&mut keyboard, "rresume\x1b", 5_900), [STOP]);
        assert_eq!(press(&mut keyboard, "rresume\n", 7_800)[0], Command::TooSoon);
    }

    /// Presses as of a frightened user: every key that stops, in 60 rhythms, also after a release was begun.
    #[test]
    fn dashboard_never_releases_while_keys_are_hammered() {
        for rhythm in 0..60_u64 {
            let every_ms = 50 + rhythm * 1_950 / 59;
            for hammered in
                ["s", "S", " ", "\x1b", "\x13", "\n", "s\n", " \n", "\x1bs \n", "r", "rs", "r\n"]
            {
                for before in ["", "r", "rresum", "rresume"] {
                    let mut keyboard = Keyboard::default();
                    press(&mut keyboard, before, 0);
                    // Only the word typed in full makes one Enter a release, and it was typed by the user.
                    let may_release = before == "rresume" && hammered.starts_with('\n');
                    let mut commands = Vec::new();
                    for (number, c) in hammered.chars().cycle().take(100).enumerate() {
                        let ms = 3_000 + number as u64 * every_ms;
                        commands.extend(keyboard.press(key(c), SEEN, at(ms)));
                    }
                    let releases = commands.iter().filter(|command| **command == RELEASE).count();
                    assert!(
                        releases <= usize::from(may_release),
                        "{hammered:?} every {every_ms} ms after {before:?}: {commands:?}"
                    );
                    let stops = hammered.chars().any(|c| "sS \x1b\x13".contains(c));
                    assert!(!stops || commands.contains(&STOP), "{hammered:?} after {before:?}");
                }
            }
        }
    }

    #[test]
    fn dashboard_stops_the_arm_also_while_text_is_typed() {
        let mut keyboard = Keyboard::in_mode(Mode::Typing("the".into()));
        assert_eq!(keyboard.press(control('s'), SEEN, at(0)), Some(STOP));
        assert_eq!(keyboard.mode, Mode::Typing("the".into()));
        assert_eq!(press(&mut keyboard, "\x1b\x1b", 0), [STOP], "the first one ends the line");
        assert_eq!(keyboard.press(control('c'), SEEN, at(0)), Some(Command::Quit));
    }
}
