//! Output of the verbs.
//!
//! Invariant: results go to standard output, as text or as JSON; progress and errors go to standard
//! error, with `--json` errors also to standard output as `{"schema","error","exit"}`. Colour
//! needs a terminal, without `NO_COLOR`. All output passes [`printable`], so that texts are harmless.

use service::exit::Failure;
use service::json_schema::with_schema;
use service::printable::{printable, printable_json};
use std::borrow::Cow;
use std::fmt::{self, Display};
use std::io::{self, BufWriter, IsTerminal, Write};

use serde::Serialize;

/// Output of a verb.
pub struct Output<'a> {
    sink: Box<dyn Write + 'a>,
    json: bool,
    terminal: bool,
    style: Style,
}

/// Text style of the output: coloured or plain.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Style {
    /// Escape sequences are understood.
    pub colour: bool,
}

/// Emphasis of a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ink {
    /// Most important text.
    Bold,
    /// Least important text.
    Dim,
    /// Good state.
    Green,
    /// Work in progress.
    Yellow,
    /// Bad state.
    Red,
    /// The robot's words.
    Cyan,
}

/// Text in an [`Ink`], or plain.
#[derive(Clone, Copy, Debug)]
pub struct Painted<T> {
    text: T,
    ink: Option<Ink>,
}

impl Output<'static> {
    /// Standard output, which appears when a line is complete.
    pub fn standard(json: bool) -> Self {
        let terminal = io::stdout().is_terminal();
        let sink = Box::new(BufWriter::with_capacity(1 << 16, io::stdout().lock()));
        Self { sink, json, terminal, style: Style { colour: terminal && colour_is_welcome() } }
    }
}

impl<'a> Output<'a> {
    /// Prints to `sink`, without colour.
    pub fn to(sink: impl Write + 'a, json: bool) -> Self {
        Self { sink: Box::new(sink), json, terminal: false, style: Style::default() }
    }

    /// Returns true if JSON was requested.
    pub fn is_json(&self) -> bool {
        self.json
    }

    /// Returns true if the output is a terminal that can be redrawn.
    pub fn is_terminal(&self) -> bool {
        self.terminal
    }

    /// Returns the emphasis that the output supports.
    pub fn style(&self) -> Style {
        self.style
    }

    /// Prints a line, at once.
    ///
    /// # Errors
    /// The output is closed or full.
    pub fn line(&mut self, text: impl Display) -> Result<(), Failure> {
        self.queue_line(text)?;
        self.flush()
    }

    /// Prints a line some time before [`Output::flush`] returns.
    ///
    /// # Errors
    /// The output is closed or full.
    pub fn queue_line(&mut self, text: impl Display) -> Result<(), Failure> {
        let text = text.to_string();
        writeln!(self.sink, "{}", self.style.clean(&text)).map_err(Failure::output)
    }

    /// Prints a value as one line of JSON, at once. With `--json` an object begins with its `schema`.
    ///
    /// # Errors
    /// The output is closed or full.
    pub fn json(&mut self, value: &impl Serialize) -> Result<(), Failure> {
        let json = to_json(value)?;
        self.queue_text(&if self.json { with_schema(&json) } else { json })?;
        self.flush()
    }

    /// Prints a line of a batch tool, some time before [`Output::flush`] returns: JSON in the form of its input, which
    /// has no schema.
    ///
    /// # Errors
    /// The output is closed or full.
    pub fn queue_json(&mut self, value: &impl Serialize) -> Result<(), Failure> {
        self.queue_text(&to_json(value)?)
    }

    fn queue_text(&mut self, json: &str) -> Result<(), Failure> {
        writeln!(self.sink, "{}", printable_json(json)).map_err(Failure::output)
    }

    /// Prints text of this program's own as it is, at once.
    ///
    /// # Errors
    /// The output is closed or full.
    pub fn text(&mut self, text: &str) -> Result<(), Failure> {
        self.sink.write_all(text.as_bytes()).map_err(Failure::output)?;
        self.flush()
    }

    /// Flushes the output.
    ///
    /// # Errors
    /// The output is closed or full.
    pub fn flush(&mut self) -> Result<(), Failure> {
        self.sink.flush().map_err(Failure::output)
    }
}

fn to_json(value: &impl Serialize) -> Result<String, Failure> {
    serde_json::to_string(value).map_err(|error| Failure::output(error.into()))
}

impl Style {
    /// Returns `text` in `ink`, if the output understands colours.
    pub fn paint<T: Display>(self, ink: Ink, text: T) -> Painted<T> {
        Painted { text, ink: self.colour.then_some(ink) }
    }

    /// Returns the text without controls of a terminal, except for its own inks.
    pub fn clean(self, text: &str) -> Cow<'_, str> {
        let mut kept = Ink::ALL.map(Ink::sequence).to_vec();
        kept.push(Ink::END);
        printable(text, if self.colour { &kept } else { &[] })
    }
}

impl<T: Display> Display for Painted<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.ink {
            None => self.text.fmt(f),
            Some(ink) => write!(f, "{}{}{}", ink.sequence(), self.text, Ink::END),
        }
    }
}

impl Ink {
    const ALL: [Self; 6] =
        [Self::Bold, Self::Dim, Self::Green, Self::Yellow, Self::Red, Self::Cyan];
    const END: &'static str = "\x1b[0m";

    const fn sequence(self) -> &'static str {
        match self {
            Self::Bold => "\x1b[1m",
            Self::Dim => "\x1b[2m",
            Self::Green => "\x1b[32m",
            Self::Yellow => "\x1b[33m",
            Self::Red => "\x1b[31m",
            Self::Cyan => "\x1b[36m",
        }
    }
}

/// Prints a note on standard error, apart from the verb's result.
pub fn note(text: impl Display) {
    note_in(Style::default(), &text.to_string());
}

fn note_in(style: Style, text: &str) {
    // Nothing to do if standard error is closed.
    let _ = writeln!(io::stderr(), "{}", style.clean(text));
}

/// Prints the message of a failure, if it has one, on standard error.
pub fn print_error(failure: &Failure) {
    if failure.message.is_empty() {
        return;
    }
    let style = Style { colour: io::stderr().is_terminal() && colour_is_welcome() };
    note_in(style, &format!("{} {failure}", style.paint(Ink::Red, "error:")));
}

/// Prints a failure that has a message as `{"error","exit"}` on standard output, for `--json`.
pub fn print_json_error(failure: &Failure) {
    if failure.message.is_empty() {
        return;
    }
    let mut out = Output::standard(true);
    let error = serde_json::json!({ "error": failure.message, "exit": failure.exit as u8 });
    // Nothing to do if standard output is closed.
    let _ = out.json(&error);
}

fn colour_is_welcome() -> bool {
    std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
}

/// Renders rows below their headings, each column as wide as its widest cell.
pub fn table(heads: &[&str], rows: &[Vec<String>]) -> Vec<String> {
    let width = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column));
        cells.map(|cell| cell.chars().count()).chain([heads[column].len()]).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..heads.len()).map(width).collect();
    let line = |cells: &[&str]| {
        let padded = cells.iter().zip(&widths).map(|(cell, width)| format!("{cell:width$}"));
        padded.collect::<Vec<_>>().join("  ").trim_end().to_owned()
    };
    let rows = rows.iter().map(|row| line(&row.iter().map(String::as_str).collect::<Vec<_>>()));
    std::iter::once(line(heads)).chain(rows).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_as_wide_as_their_widest_cell() {
        let rows = [vec!["arm".to_owned(), "ready".to_owned()], vec!["grounding".to_owned()]];
        let lines = table(&["SERVICE", "STATE"], &rows);
        assert_eq!(lines, ["SERVICE    STATE", "arm        ready", "grounding"]);
    }

    #[test]
    fn colour_is_put_only_where_it_is_understood() {
        assert_eq!(Style { colour: false }.paint(Ink::Red, "no").to_string(), "no");
        assert_eq!(Style { colour: true }.paint(Ink::Red, "no").to_string(), "\x1b[31mno\x1b[0m");
    }

    #[test]
    fn foreign_text_does_not_steer_the_terminal() {
        let mut bytes = Vec::new();
        let mut out = Output::to(&mut bytes, false);
        out.line("he said \x1b[2J\x1b]52;c;eA==\x07 and \u{9b}H").unwrap();
        out.json(&"\u{9b}H \u{202e}").unwrap();
        drop(out);
        assert_eq!(
            String::from_utf8(bytes).unwrap(),
            "he said \\u{1b}[2J\\u{1b}]52;c;eA==\\u{7} and \\u{9b}H\n\"\\u009bH \\u202e\"\n"
        );
        let style = Style { colour: true };
        let painted = style.paint(Ink::Red, "no \x1b[H").to_string();
        assert_eq!(style.clean(&painted), "\x1b[31mno \\u{1b}[H\x1b[0m");
    }

    #[test]
    fn json_value_is_printed_on_one_line() {
        let mut bytes = Vec::new();
        let value = serde_json::json!({"a": "b\nc"});
        Output::to(&mut bytes, true).json(&value).unwrap();
        Output::to(&mut bytes, false).json(&value).unwrap();
        assert_eq!(bytes, b"{\"schema\":1,\"a\":\"b\\nc\"}\n{\"a\":\"b\\nc\"}\n");
    }
}
