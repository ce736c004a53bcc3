//! Foreign text on a terminal: what a person, a program or a log says must not steer it.

use std::borrow::Cow;

/// Returns the text with every character that could steer a terminal, or reorder what stands there,
/// written as an escape (`\u{1b}`). Line feeds, tabs and the sequences `kept` stay.
pub fn printable<'a>(text: &'a str, kept: &[&str]) -> Cow<'a, str> {
    cleaned(text, |c| is_hostile(c) && !matches!(c, '\n' | '\t'), kept)
}

/// As [`printable`], on one line: line feeds and tabs are written as escapes, too.
pub fn one_line(text: &str) -> Cow<'_, str> {
    cleaned(text, is_hostile, &[])
}

/// Returns JSON with every such character inside its strings written as `\u….`
pub fn printable_json(json: &str) -> Cow<'_, str> {
    if !json.contains(is_hostile) {
        return Cow::Borrowed(json);
    }
    // The serialiser escapes what is below a blank; all others are of the basic plane.
    let escaped = |c: char| format!("\\u{:04x}", u32::from(c));
    let written = |c: char| if is_hostile(c) { escaped(c) } else { c.to_string() };
    Cow::Owned(json.chars().map(written).collect())
}

/// Control characters (C0, DEL and C1) and those that change the direction of text.
fn is_hostile(c: char) -> bool {
    c.is_control()
        || matches!(c, '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

fn cleaned<'a>(text: &'a str, is_bad: impl Fn(char) -> bool, kept: &[&str]) -> Cow<'a, str> {
    if !text.contains(&is_bad) {
        return Cow::Borrowed(text);
    }
    let (mut clean, mut rest) = (String::with_capacity(text.len()), text);
    while let Some(c) = rest.chars().next() {
        let sequence = kept.iter().find(|sequence| rest.starts_with(**sequence));
        let length = sequence.map_or(c.len_utf8(), |sequence| sequence.len());
        match sequence {
            None if is_bad(c) => clean.extend(c.escape_default()),
            _ => clean.push_str(&rest[..length]),
        }
        rest = &rest[length..];
    }
    Cow::Owned(clean)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hostile_characters_are_escaped_and_words_are_not() {
        let words = "get me the „weiße“ bowl: 碗 🥣\n\tplease";
        assert_eq!(printable(words, &[]), words);
        assert_eq!(one_line("a\nb\tc"), "a\\nb\\tc");
        let hostile = "\x1b]0;title\x07 \x1b[2J \u{9b}31m \u{202e}abc \r\x7f";
        let clean = printable(hostile, &[]);
        assert_eq!(clean, "\\u{1b}]0;title\\u{7} \\u{1b}[2J \\u{9b}31m \\u{202e}abc \\r\\u{7f}");
        assert!(!clean.contains(is_hostile));
        let painted = "\x1b[31mno\x1b[0m \x1b[2J";
        assert_eq!(printable(painted, &["\x1b[31m", "\x1b[0m"]), "\x1b[31mno\x1b[0m \\u{1b}[2J");
    }

    #[test]
    fn escaped_json_means_the_same() {
        for c in (0..=0x2100).filter_map(char::from_u32) {
            let value = serde_json::json!({ "said": format!("a{c}b") });
            let line = printable_json(&value.to_string()).into_owned();
            assert!(!line.contains(is_hostile), "{line:?}");
            assert_eq!(serde_json::from_str::<serde_json::Value>(&line).unwrap(), value);
        }
    }
}
