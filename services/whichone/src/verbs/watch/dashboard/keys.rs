//! Keys of the dashboard.

use messages::MotionOrder;
use ratatui::crossterm::event::{KeyCode, KeyEvent, KeyEventKind, KeyModifiers};

/// Most characters of a line that is typed.
const CHARS_MAX: usize = 500;

/// What the user asks for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Command {
    /// End the dashboard.
    Quit,
    /// Latch or release the motion stop.
    Motion(MotionOrder),
    /// Say this to the robot.
    Say(String),
}

/// What keys mean at the moment.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) enum Keyboard {
    /// Each key is a command.
    #[default]
    Watching,
    /// Keys are text for the robot, so far this.
    Typing(String),
    /// A release of the motion stop waits for its confirmation: pasted text must not make an arm move.
    Releasing,
}

impl Keyboard {
    /// Takes a key. Ctrl-S stops the arm and Ctrl-C quits, whatever the other keys mean.
    pub(super) fn press(&mut self, key: KeyEvent) -> Option<Command> {
        if key.kind == KeyEventKind::Release {
            return None;
        }
        if key.modifiers.contains(KeyModifiers::CONTROL) {
            return match key.code {
                KeyCode::Char('c') => Some(Command::Quit),
                KeyCode::Char('s') => Some(Command::Motion(MotionOrder::Stop)),
                _ => None,
            };
        }
        match std::mem::take(self) {
            Self::Watching => self.command(key.code),
            Self::Typing(text) => self.typed(text, key.code),
            Self::Releasing => {
                (key.code == KeyCode::Enter).then_some(Command::Motion(MotionOrder::Resume))
            }
        }
    }

    fn command(&mut self, code: KeyCode) -> Option<Command> {
        match code {
            KeyCode::Char('q') => return Some(Command::Quit),
            KeyCode::Char('s') => return Some(Command::Motion(MotionOrder::Stop)),
            KeyCode::Char('r') => *self = Self::Releasing,
            KeyCode::Char('t') | KeyCode::Enter => *self = Self::Typing(String::new()),
            _ => {}
        }
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
        *self = Self::Typing(text);
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn press(keyboard: &mut Keyboard, keys: &str) -> Vec<Command> {
        let code = |c| match c {
            '\n' => KeyCode::Enter,
            '\x1b' => KeyCode::Esc,
            '\x08' => KeyCode::Backspace,
            c => KeyCode::Char(c),
        };
        let key = |c| KeyEvent::new(code(c), KeyModifiers::NONE);
        keys.chars().filter_map(|c| keyboard.press(key(c))).collect()
    }

    #[test]
    fn dashboard_keys_are_commands_until_text_is_typed() {
        let mut keyboard = Keyboard::default();
        assert_eq!(press(&mut keyboard, "xs"), [Command::Motion(MotionOrder::Stop)]);
        let said = press(&mut keyboard, "tthe cupsx\x08\n");
        assert_eq!(said, [Command::Say("the cups".to_owned())]);
        assert_eq!(press(&mut keyboard, "\nq \x1b"), []);
        assert_eq!(press(&mut keyboard, "t  \nq"), [Command::Quit]);
    }

    #[test]
    fn dashboard_releases_the_stop_only_when_confirmed() {
        let mut keyboard = Keyboard::default();
        assert_eq!(press(&mut keyboard, "r\n"), [Command::Motion(MotionOrder::Resume)]);
        assert_eq!(press(&mut keyboard, "rx\n\x1b"), []);
        assert_eq!(keyboard, Keyboard::Watching);
    }

    #[test]
    fn dashboard_stops_the_arm_also_while_text_is_typed() {
        let mut keyboard = Keyboard::Typing("the".into());
        let control = |c| KeyEvent::new(KeyCode::Char(c), KeyModifiers::CONTROL);
        assert_eq!(keyboard.press(control('s')), Some(Command::Motion(MotionOrder::Stop)));
        assert_eq!(keyboard, Keyboard::Typing("the".into()));
        assert_eq!(keyboard.press(control('c')), Some(Command::Quit));
    }
}
