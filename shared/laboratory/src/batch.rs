//! Batch tools: one JSON object a line in, one out, in the same order.
//!
//! Invariant: every line that is not blank gets exactly one line of output, whatever it holds; an
//! answer depends on its own line alone.

use std::io::{self, BufRead, BufReader, Read};

use command_line::Outcome;
use command_line::output::Output;
use serde::de::DeserializeOwned;
use serde_json::{Value as Json, json};
use service::exit::{Exit, Failure};

use crate::args::InputArgs;

mod belief;
mod calibrate;
mod ground;
mod kinematics;
mod plan;

pub use belief::belief;
pub use calibrate::{Calibrator, calibrate};
pub use ground::{Grounder, ground};
pub use kinematics::{fk, ik};
pub use plan::{Decider, Problem, plan};

/// Bytes read at a time.
const BUFFER_BYTES: usize = 1 << 16;

/// Answers every line of `input`; a line that cannot be answered gets
/// `{"line":n,"error":"…"}`, and the exit code says that there was one.
///
/// Answers are printed when a buffer is full or when the next line is not there yet, so that long
/// inputs are fast and a person or program that waits for each answer gets it.
///
/// # Errors
/// The input cannot be read, or the output cannot be written.
pub fn run<A>(input: impl Read, out: &mut Output<'_>, mut answer: A) -> Outcome
where
    A: FnMut(&[u8]) -> Result<Json, String>,
{
    let mut input = BufReader::with_capacity(BUFFER_BYTES, input);
    let (mut line, mut number, mut exit) = (Vec::new(), 0_u64, Exit::Ok);
    loop {
        if !input.buffer().contains(&b'\n') {
            out.flush()?;
        }
        line.clear();
        let unreadable =
            |e: io::Error| Failure::new(Exit::Storage, format!("the input cannot be read: {e}"));
        if input.read_until(b'\n', &mut line).map_err(unreadable)? == 0 {
            out.flush()?;
            return Ok(exit);
        }
        number += 1;
        let text = strip(&line, number);
        if text.is_empty() {
            continue;
        }
        match answer(text) {
            Ok(answer) => out.queue_json(&answer)?,
            Err(error) => {
                exit = Exit::NotReached;
                out.queue_json(&json!({ "line": number, "error": error }))?;
            }
        }
    }
}

/// Opens the requested input.
///
/// # Errors
/// The file does not exist.
pub fn open(input: &InputArgs) -> Result<Box<dyn Read>, Failure> {
    let Some(path) = &input.input else { return Ok(Box::new(io::stdin().lock())) };
    let file = safe_files::open_regular(path).map_err(|error| Failure::file(path, &error))?;
    Ok(Box::new(file))
}

/// The line without blanks around it, and without the mark that some editors put at the start of
/// a file.
fn strip(line: &[u8], number: u64) -> &[u8] {
    let line = match line.strip_prefix("\u{feff}".as_bytes()) {
        Some(rest) if number == 1 => rest,
        _ => line,
    };
    line.trim_ascii()
}

/// Parses a line, or returns its error.
fn parse<T: DeserializeOwned>(line: &[u8]) -> Result<T, String> {
    serde_json::from_slice(line).map_err(|error| {
        let text = error.to_string();
        // Every input is one line, so only the column helps.
        text.replace(" at line 1 column ", " at column ")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn echo(line: &[u8]) -> Result<Json, String> {
        parse(line)
    }

    fn answers(input: &[u8]) -> (String, Exit) {
        let mut bytes = Vec::new();
        let exit = run(input, &mut Output::to(&mut bytes, true), echo).unwrap();
        (String::from_utf8(bytes).unwrap(), exit)
    }

    #[test]
    fn every_line_is_answered_in_order_and_blank_ones_are_passed_over() {
        let (text, exit) = answers(b"{\"a\":1}\r\n\n  \t\n[2]\n3");
        assert_eq!((text.as_str(), exit), ("{\"a\":1}\n[2]\n3\n", Exit::Ok));
        assert_eq!(answers(b""), (String::new(), Exit::Ok));
        assert_eq!(answers("\u{feff}1\n".as_bytes()), ("1\n".into(), Exit::Ok));
    }

    #[test]
    fn a_bad_line_is_reported_by_its_number_and_stops_nothing() {
        let (text, exit) = answers(b"1\n\n{\"a\"\n\xff\xfe\n4\n");
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 4);
        assert_eq!((lines[0], lines[3], exit), ("1", "4", Exit::NotReached));
        assert!(lines[1].starts_with("{\"line\":3,\"error\":\""), "{}", lines[1]);
        assert!(lines[1].contains("column 4"), "{}", lines[1]);
        assert!(lines[2].starts_with("{\"line\":4,"), "{}", lines[2]);
    }

    #[test]
    fn lines_may_be_of_any_length_and_depth() {
        let long = format!("\"{}\"\n1\n", "x".repeat(5 * BUFFER_BYTES));
        let (text, exit) = answers(long.as_bytes());
        assert_eq!((text.len(), exit), (long.len(), Exit::Ok));
        let deep = format!("{}{}\n1\n", "[".repeat(100_000), "]".repeat(100_000));
        let (text, exit) = answers(deep.as_bytes());
        assert!(text.contains("recursion limit") && text.ends_with("\n1\n"));
        assert_eq!(exit, Exit::NotReached);
    }

    /// A caller that waits for each answer before it writes the next line receives it.
    #[test]
    fn an_answer_appears_before_the_next_line_is_waited_for() {
        use std::cell::RefCell;
        use std::collections::VecDeque;
        use std::rc::Rc;

        #[derive(Clone, Default)]
        struct Seen(Rc<RefCell<Vec<u8>>>);
        impl io::Write for Seen {
            fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
                self.0.borrow_mut().extend_from_slice(bytes);
                Ok(bytes.len())
            }
            fn flush(&mut self) -> io::Result<()> {
                Ok(())
            }
        }
        struct Patient(Seen, VecDeque<&'static [u8]>, usize);
        impl Read for Patient {
            fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
                let answered = self.0.0.borrow().iter().filter(|&&byte| byte == b'\n').count();
                assert_eq!(answered, self.2, "answers seen before this read");
                let Some(bytes) = self.1.pop_front() else { return Ok(0) };
                self.2 += bytes.iter().filter(|&&byte| byte == b'\n').count();
                into[..bytes.len()].copy_from_slice(bytes);
                Ok(bytes.len())
            }
        }
        let seen = Seen::default();
        let input = Patient(seen.clone(), [&b"1\n2\n"[..], b"3", b"4\n"].into(), 0);
        let buffered = io::BufWriter::new(seen.clone());
        run(input, &mut Output::to(buffered, true), echo).unwrap();
        assert_eq!(*seen.0.borrow(), b"1\n2\n34\n");
    }
}
