//! `whichone watch` on a terminal: a pseudo-terminal with a small emulator of what it shows.

use rustix::fs::{OFlags, open};
use rustix::pty::{OpenptFlags, grantpt, openpt, ptsname, unlockpt};
use rustix::termios::{Winsize, tcsetwinsize};
use std::fs::File;
use std::io::{Read, Write};
use std::process::{Child, Command, Stdio};
use std::sync::{Arc, Mutex};
use whichone_tests::{Group, wait_for};

/// A terminal with a program in it.
pub(crate) struct Terminal {
    master: File,
    pub(crate) child: Child,
    screen: Arc<Mutex<Screen>>,
}

impl Terminal {
    /// Starts a program in a terminal of that size, which does not show its errors.
    pub(crate) fn start(command: &mut Command, columns: u16, rows: u16) -> Self {
        Self::start_with(command, (columns, rows), |_| Stdio::piped())
    }

    /// Starts a program in a terminal of that size, which is its standard error as well if `errors` returns it.
    pub(crate) fn start_with(
        command: &mut Command,
        (columns, rows): (u16, u16),
        errors: impl FnOnce(Stdio) -> Stdio,
    ) -> Self {
        let master = openpt(OpenptFlags::RDWR | OpenptFlags::NOCTTY).unwrap();
        grantpt(&master).unwrap();
        unlockpt(&master).unwrap();
        resize(&master, columns, rows);
        let name = ptsname(&master, Vec::new()).unwrap();
        let end = || open(&name, OFlags::RDWR | OFlags::NOCTTY, rustix::fs::Mode::empty()).unwrap();
        command.stdin(end()).stdout(end()).stderr(errors(end().into())).env_remove("NO_COLOR");
        let child = command.spawn().unwrap();
        let master = File::from(master);
        let screen = Arc::new(Mutex::new(Screen::default()));
        let (mut output, shown) = (master.try_clone().unwrap(), Arc::clone(&screen));
        std::thread::spawn(move || {
            let mut bytes = [0; 4096];
            // The end of the program is an error of the terminal.
            while let Ok(count @ 1..) = output.read(&mut bytes) {
                shown.lock().unwrap().take(&bytes[..count]);
            }
        });
        Self { master, child, screen }
    }

    pub(crate) fn press(&mut self, keys: &str) {
        self.master.write_all(keys.as_bytes()).unwrap();
    }

    pub(crate) fn wait_for(&self, what: &str, is_shown: impl Fn(&[String]) -> bool) {
        wait_for(what, 15.0, || is_shown(&self.screen.lock().unwrap().lines()).then_some(()));
    }
}

impl Terminal {
    /// What is shown.
    pub(crate) fn lines(&self) -> Vec<String> {
        self.screen.lock().unwrap().lines()
    }
}

impl Drop for Terminal {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn resize(terminal: impl std::os::fd::AsFd, columns: u16, rows: u16) {
    let size = Winsize { ws_row: rows, ws_col: columns, ws_xpixel: 0, ws_ypixel: 0 };
    tcsetwinsize(terminal, size).unwrap();
}

/// What a terminal shows: text, moves of the cursor, erasing of the whole and of a line's end; the rest is left
/// out.
#[derive(Default)]
struct Screen {
    cells: Vec<Vec<char>>,
    at: (usize, usize),
    pending: Vec<u8>,
    raw: String,
}

impl Screen {
    fn take(&mut self, bytes: &[u8]) {
        self.pending.extend(bytes);
        let whole = match std::str::from_utf8(&self.pending) {
            Ok(text) => text.len(),
            Err(error) => error.valid_up_to(),
        };
        let text = String::from_utf8(self.pending.drain(..whole).collect()).unwrap();
        self.raw += &text;
        // A sequence that has not arrived whole waits for its end.
        let mut rest = text.as_str();
        while let Some(c) = rest.chars().next() {
            let Some(sequence) = rest.strip_prefix("\x1b[") else {
                rest = &rest[c.len_utf8()..];
                self.put(c);
                continue;
            };
            let Some(end) = sequence.find(|c: char| ('@'..='~').contains(&c)) else {
                self.pending.splice(0..0, rest.bytes());
                return;
            };
            self.control(&sequence[..end], sequence.as_bytes()[end]);
            rest = &sequence[end + 1..];
        }
    }

    fn control(&mut self, parameters: &str, end: u8) {
        match end {
            b'H' => {
                let mut numbers = parameters.split(';').map(|n| n.parse().unwrap_or(1));
                let (row, column) = (numbers.next().unwrap_or(1), numbers.next().unwrap_or(1));
                self.at = (row - 1, column - 1);
            }
            b'J' if parameters == "2" => self.cells.clear(),
            b'K' => {
                let (row, column) = self.at;
                self.cells.iter_mut().skip(row).take(1).for_each(|cells| cells.truncate(column));
            }
            _ => {}
        }
    }

    fn put(&mut self, c: char) {
        let (row, column) = self.at;
        match c {
            '\r' => self.at.1 = 0,
            '\n' => self.at.0 += 1,
            c if c.is_control() => {}
            c => {
                self.cells.resize(self.cells.len().max(row + 1), Vec::new());
                let cells = &mut self.cells[row];
                cells.resize(cells.len().max(column + 1), ' ');
                cells[column] = c;
                self.at.1 += 1;
            }
        }
    }

    fn lines(&self) -> Vec<String> {
        self.cells.iter().map(|row| row.iter().collect()).collect()
    }
}

pub(crate) fn has(lines: &[String], part: &str) -> bool {
    lines.iter().any(|line| line.contains(part))
}

#[test]
fn watch_on_a_terminal_shows_the_dialogue_obeys_keys_and_follows_its_size() {
    let group = Group::up(&[]);
    let mut terminal = Terminal::start(&mut group.command(&["watch"]), 110, 32);
    terminal.wait_for("belief and services", |lines| {
        has(lines, "white2") && has(lines, "speech     ready") && has(lines, "q quit")
    });
    terminal.press("tget me the bowl\r");
    terminal.wait_for("a question", |lines| has(lines, "robot  ") && has(lines, "decision: ask"));
    terminal.press("s");
    terminal.wait_for("the stop", |lines| has(lines, "STOPPED"));
    group.wait_shown(true);
    // Right after a stop nothing resumes, so the key is pressed until it counts.
    terminal.wait_for("the confirmed stop", |lines| has(lines, "the arm is stopped, at rest"));
    wait_for("what a release asks", 15.0, || {
        terminal.press("r");
        std::thread::sleep(std::time::Duration::from_millis(200));
        has(&terminal.lines(), "to let the arm move, type resume").then_some(())
    });
    assert_eq!(group.arm()["stopped"], true);
    terminal.press("resume\r");
    terminal.wait_for("the release", |lines| !has(lines, "STOPPED"));
    group.wait_shown(false);
    resize(&terminal.master, 60, 20);
    terminal.wait_for("a smaller picture", |lines| {
        has(lines, "speech ready")
            && lines.len() <= 20
            && lines.iter().all(|l| l.chars().count() <= 60)
    });
    group.must(&["hold", "grounding"]);
    terminal.wait_for("the held service", |lines| has(lines, "grounding held"));
    terminal.press("q");
    let ended = wait_for("the end", 10.0, || terminal.child.try_wait().unwrap());
    assert_eq!(ended.code(), Some(0));
    let raw = wait_for("the terminal as it was", 5.0, || {
        let raw = terminal.screen.lock().unwrap().raw.clone();
        raw.contains("\x1b[?1049l").then_some(raw)
    });
    assert!(raw.contains("\x1b[?1049h"));
    group.down();
}

#[test]
fn watch_is_plain_text_where_that_is_asked_for_or_there_is_no_terminal() {
    let group = Group::up(&[]);
    let mut terminal = Terminal::start(&mut group.command(&["watch", "--plain"]), 100, 30);
    terminal.wait_for("the plain picture", |lines| has(lines, "nothing is asked for"));
    // Keys mean nothing there.
    terminal.press("q");
    terminal.wait_for("the plain picture", |lines| !has(lines, "q quit"));
    assert!(terminal.child.try_wait().unwrap().is_none());
    drop(terminal);
    let mut piped = group.command(&["watch"]).stdout(Stdio::piped()).spawn().unwrap();
    let mut text = [0; 64];
    let count = piped.stdout.as_mut().unwrap().read(&mut text).unwrap();
    assert!(count > 0 && !text.contains(&0x1b), "{text:?}");
    let _ = piped.kill();
    let _ = piped.wait();
    group.down();
}
