//! Numbers in the cells of tables.

use std::ops::Range;

/// A number in a text.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Number {
    pub(super) value: f64,
    /// Digits behind the point.
    pub(super) decimals: usize,
    /// Where it stands.
    pub(super) span: Range<usize>,
}

/// Returns the numbers of a text. Digits behind a letter belong to a name, as in `p50`.
pub(super) fn numbers(text: &str) -> Vec<Number> {
    let (bytes, mut numbers, mut at) = (text.as_bytes(), Vec::new(), 0);
    while at < bytes.len() {
        let is_start = bytes[at].is_ascii_digit();
        let is_named = at > 0 && (bytes[at - 1].is_ascii_alphanumeric() || bytes[at - 1] == b'_');
        let len = length(&bytes[at..]);
        if is_start && !is_named {
            numbers.extend(number(text, at..at + len));
        }
        at += len.max(1);
    }
    numbers
}

/// Bytes of the number at the beginning: digits, a point with digits, and commas before three digits.
fn length(bytes: &[u8]) -> usize {
    let digits = |from: usize| bytes[from..].iter().take_while(|b| b.is_ascii_digit()).count();
    let mut len = digits(0);
    while len > 0 && bytes.get(len) == Some(&b',') && digits(len + 1) == 3 {
        len += 4;
    }
    match bytes.get(len) {
        Some(b'.') if len > 0 && digits(len + 1) > 0 => len + 1 + digits(len + 1),
        _ => len,
    }
}

fn number(text: &str, mut span: Range<usize>) -> Option<Number> {
    let digits = text[span.clone()].replace(',', "");
    let decimals = digits.split_once('.').map_or(0, |(_, behind)| behind.len());
    let before = text[..span.start].chars().rev();
    // A dash behind a digit or a letter joins two of a kind: 12–20, x-2.
    let sign = ['-', '−'].into_iter().find(|sign| {
        let mut before = before.clone();
        before.next() == Some(*sign) && !before.next().is_some_and(char::is_alphanumeric)
    });
    span.start -= sign.map_or(0, char::len_utf8);
    let value: f64 = digits.parse().ok()?;
    let value = if sign.is_some() { -value } else { value };
    Some(Number { value, decimals, span })
}

/// Returns the text with other numbers in place of its own, one for each. None has more digits behind
/// the point than before, unless less than two significant ones would remain.
pub(super) fn replaced(text: &str, values: &[f64]) -> String {
    let mut replaced = text.to_owned();
    for (number, value) in numbers(text).iter().zip(values).rev() {
        let short = format!("{value:.*}", number.decimals);
        let is_whole = *value == value.round();
        let new = if is_whole || value.abs() >= 10.0 { short } else { longer(&short, *value) };
        replaced.replace_range(number.span.clone(), &new);
    }
    replaced
}

fn longer(short: &str, value: f64) -> String {
    let shown = short.trim_start_matches(['-', '0', '.']);
    let digits = shown.chars().filter(char::is_ascii_digit).count();
    if digits < 2 { significant(value) } else { short.to_owned() }
}

/// Returns a value with two significant digits, and at least up to the point.
pub(super) fn significant(value: f64) -> String {
    let decimals = (1.0 - value.abs().log10().floor()).clamp(0.0, 9.0);
    if value == 0.0 { "0".to_owned() } else { format!("{value:.*}", decimals as usize) }
}
