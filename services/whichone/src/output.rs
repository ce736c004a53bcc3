//! Output of the verbs.
//!
//! Invariant: results go to standard output, as text or as JSON; progress and errors go to standard
//! error. Colour appears on terminals only, and never where `NO_COLOR` is set.

use service::exit::Failure;
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
    /// In progress.
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
    /// Standard output. What is printed appears when a line is complete.
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

    /// Returns true if JSON is asked for.
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
        writeln!(self.sink, "{text}").map_err(Failure::output)
    }

    /// Prints a value as one line of JSON, at once.
    ///
    /// # Errors
    /// The output is closed or full.
    pub fn json(&mut self, value: &impl Serialize) -> Result<(), Failure> {
        self.queue_json(value)?;
        self.flush()
    }

    /// Prints a value as one line of JSON some time before [`Output::flush`] returns.
    ///
    /// # Errors
    /// The output is closed or full.
    pub fn queue_json(&mut self, value: &impl Serialize) -> Result<(), Failure> {
        serde_json::to_writer(&mut self.sink, value).map_err(|e| Failure::output(e.into()))?;
        self.sink.write_all(b"\n").map_err(Failure::output)
    }

    /// Prints text as it is, at once.
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

impl Style {
    /// `text` in `ink`, where that is understood.
    pub fn paint<T: Display>(self, ink: Ink, text: T) -> Painted<T> {
        Painted { text, ink: self.colour.then_some(ink) }
    }
}

impl<T: Display> Display for Painted<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Some(ink) = self.ink else { return self.text.fmt(f) };
        let code = match ink {
            Ink::Bold => 1,
            Ink::Dim => 2,
            Ink::Red => 31,
            Ink::Green => 32,
            Ink::Yellow => 33,
            Ink::Cyan => 36,
        };
        write!(f, "\x1b[{code}m{}\x1b[0m", self.text)
    }
}

/// Prints a note beside the verb's result, on standard error.
pub fn note(text: impl Display) {
    // Nothing to do if standard error is closed.
    let _ = writeln!(io::stderr(), "{text}");
}

/// Prints the message of a failure, if it has one, on standard error.
pub fn print_error(failure: &Failure) {
    if failure.message.is_empty() {
        return;
    }
    let style = Style { colour: io::stderr().is_terminal() && colour_is_welcome() };
    note(format_args!("{} {failure}", style.paint(Ink::Red, "error:")));
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
    fn json_value_is_printed_on_one_line() {
        let mut bytes = Vec::new();
        Output::to(&mut bytes, true).json(&serde_json::json!({"a": "b\nc"})).unwrap();
        assert_eq!(bytes, b"{\"a\":\"b\\nc\"}\n");
    }
}
