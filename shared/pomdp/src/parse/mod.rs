//! The parser of the format in general.
//!
//! ```text
//! preamble   discount, values, states, actions, observations: each once, in any order
//! start      start: p… | uniform | STATE    start include: STATE…    start exclude: STATE…
//! entries    T: a : s : s' p      T: a : s  ROW      T: a  MATRIX
//!            O: a : s' : o p      O: a : s' ROW      O: a  MATRIX
//!            R: a : s : s' : o v  R: a : s : s' ROW  R: a : s MATRIX
//! ```
//!
//! A ROW is numbers or `uniform` (in `T` also `reset`: the belief at the start), a MATRIX is
//! numbers or `uniform` (in `T` also `identity`); rewards are numbers alone. Whatever is named may
//! be given by its number, counted from 0, and `*` stands for every one. A later entry counts more
//! than an earlier one. `#` begins a comment. Without `start`, every state is as likely.
//!
//! It is strict: nothing may be missing, be there twice or follow out of order, and every row of
//! `T` and `O` must sum to one.

mod entries;
mod preamble;
mod token;

use crate::Pomdp;
use token::Token;

/// What is wrong with a text.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {what} ({cure})")]
pub struct ParseError {
    /// Where, counted from 1.
    pub line: usize,
    /// What is wrong.
    pub what: String,
    /// How to mend it.
    pub cure: String,
}

impl ParseError {
    fn new(line: usize, what: impl Into<String>, cure: impl Into<String>) -> Self {
        Self { line, what: what.into(), cure: cure.into() }
    }
}

/// How far the numbers of a distribution may be from a sum of one: texts round them.
const SUM_TOLERANCE: f64 = 1e-5;

impl Pomdp {
    /// Reads a problem.
    ///
    /// # Errors
    /// The first thing that is wrong, with its line and cure.
    pub fn parse(text: &str) -> Result<Self, ParseError> {
        let mut reader = Reader { tokens: token::tokens(text)?, next: 0 };
        let mut pomdp = preamble::read(&mut reader)?;
        entries::read(&mut reader, &mut pomdp)?;
        check_sums(&pomdp, reader.line())?;
        Ok(pomdp)
    }
}

fn check_sums(pomdp: &Pomdp, line: usize) -> Result<(), ParseError> {
    for (key, matrices) in [("T", &pomdp.transition), ("O", &pomdp.observation)] {
        for (action, matrix) in pomdp.actions.iter().zip(matrices) {
            for (state, name) in pomdp.states.iter().enumerate() {
                let sum = matrix.row(state).iter().fold(0.0, |sum, (_, p)| sum + p);
                if (sum - 1.0).abs() > SUM_TOLERANCE {
                    let what = format!("{key}: {action} : {name} sums to {sum}");
                    let cure = "give it probabilities that sum to 1";
                    return Err(ParseError::new(line, what, cure));
                }
            }
        }
    }
    Ok(())
}

/// The tokens, and how many of them have been read.
struct Reader<'a> {
    tokens: Vec<(usize, Token<'a>)>,
    next: usize,
}

impl<'a> Reader<'a> {
    fn peek(&self) -> Token<'a> {
        self.tokens[self.next].1
    }

    /// Line of the next token.
    fn line(&self) -> usize {
        self.tokens[self.next].0
    }

    fn take(&mut self) -> Token<'a> {
        let token = self.peek();
        // The end stays, whoever takes it.
        self.next = (self.next + 1).min(self.tokens.len() - 1);
        token
    }

    fn error<T>(&self, what: impl Into<String>, cure: impl Into<String>) -> Result<T, ParseError> {
        Err(ParseError::new(self.line(), what, cure))
    }

    /// That the next token is not what belongs there.
    fn unexpected<T>(&self, wanted: &str) -> Result<T, ParseError> {
        let found = self.peek();
        self.error(format!("{found} stands where {wanted} belongs"), format!("write {wanted}"))
    }

    fn colon(&mut self) -> Result<(), ParseError> {
        if self.peek() != Token::Colon {
            return self.unexpected("\":\"");
        }
        self.take();
        Ok(())
    }

    /// Whether that word comes next; it is read then.
    fn word(&mut self, word: &str) -> bool {
        let is = self.peek() == Token::Word(word);
        if is {
            self.take();
        }
        is
    }

    fn number(&mut self) -> Result<f64, ParseError> {
        let number = match self.peek() {
            Token::Count(count) => count as f64,
            Token::Number(number) => number,
            _ => return self.unexpected("a number"),
        };
        self.take();
        Ok(number)
    }

    fn probability(&mut self) -> Result<f64, ParseError> {
        let line = self.line();
        let number = self.number()?;
        if !(0.0..=1.0).contains(&number) {
            let what = format!("{number} is not a probability");
            return Err(ParseError::new(line, what, "use a number from 0 to 1"));
        }
        Ok(number)
    }
}
