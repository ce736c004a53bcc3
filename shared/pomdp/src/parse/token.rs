//! Words, numbers and marks, each with its line.

use super::ParseError;

/// One thing in a text.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Token<'a> {
    /// A letter followed by letters, digits, `_` and `-`.
    Word(&'a str),
    /// A count: digits alone.
    Count(usize),
    /// Any other number.
    Number(f64),
    Colon,
    Star,
    End,
}

/// Tokens with the lines that they stand on; comments are left out.
pub(super) fn tokens(text: &str) -> Result<Vec<(usize, Token<'_>)>, ParseError> {
    let mut tokens = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let number = index + 1;
        let mut rest = line.split('#').next().unwrap_or_default().trim_start();
        while let Some(first) = rest.chars().next() {
            let (token, length) = match first {
                ':' => (Token::Colon, 1),
                '*' => (Token::Star, 1),
                'a'..='z' | 'A'..='Z' => {
                    let length = length_of(rest, |c| matches!(c, '_' | '-'));
                    (Token::Word(&rest[..length]), length)
                }
                '0'..='9' | '.' | '+' | '-' => {
                    let length = length_of(rest, |c| matches!(c, '.' | '+' | '-'));
                    (numeral(&rest[..length], number)?, length)
                }
                other => {
                    let what = format!("{:?} is no part of the format", other);
                    return Err(ParseError::new(number, what, "remove it, or put a # before it"));
                }
            };
            tokens.push((number, token));
            rest = rest[length..].trim_start();
        }
    }
    tokens.push((text.lines().count(), Token::End));
    Ok(tokens)
}

/// Bytes up to the first that is neither a letter, a digit nor one of `also`.
fn length_of(text: &str, also: impl Fn(char) -> bool) -> usize {
    text.find(|c: char| !(c.is_ascii_alphanumeric() || also(c))).unwrap_or(text.len())
}

/// A number; the format knows neither "inf" nor "NaN", and Rust reads both only without digits.
fn numeral(text: &str, line: usize) -> Result<Token<'static>, ParseError> {
    let wrong = || {
        let what = format!("{text:?} is neither a number nor a name");
        ParseError::new(line, what, "write numbers as 0.5 or 1e-3; names begin with a letter")
    };
    if text.bytes().all(|byte| byte.is_ascii_digit()) {
        return text.parse().map(Token::Count).map_err(|_| wrong());
    }
    let value = text.parse::<f64>().ok().filter(|value| value.is_finite());
    let digits = text.bytes().any(|byte| byte.is_ascii_digit());
    value.filter(|_| digits).map(Token::Number).ok_or_else(wrong)
}

impl std::fmt::Display for Token<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Word(word) => write!(f, "\"{word}\""),
            Self::Count(count) => count.fmt(f),
            Self::Number(number) => number.fmt(f),
            Self::Colon => f.write_str("\":\""),
            Self::Star => f.write_str("\"*\""),
            Self::End => f.write_str("the end of the text"),
        }
    }
}
