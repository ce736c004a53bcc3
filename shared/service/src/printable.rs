//! Foreign text on a terminal: words of a person, a program or a log must not control it.

use std::borrow::Cow;

/// Returns the text with every character that could control a terminal, reorder its text, or is
/// invisible, written as an escape (`\u{1b}`). Line feeds, tabs and the sequences `kept` stay.
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
    // The serialiser escapes characters below a blank.
    let mut clean = String::with_capacity(json.len());
    for c in json.chars() {
        match is_hostile(c) {
            true => clean
                .extend(c.encode_utf16(&mut [0; 2]).iter().map(|unit| format!("\\u{unit:04x}"))),
            false => clean.push(c),
        }
    }
    Cow::Owned(clean)
}

/// Control characters (C0, DEL and C1), format characters (category Cf, also those for the
/// direction of text), and invisible ones. Emoji selectors (U+FE0E, U+FE0F) are harmless.
fn is_hostile(c: char) -> bool {
    c.is_control()
        || matches!(c,
            '\u{ad}' | '\u{34f}' | '\u{600}'..='\u{605}' | '\u{61c}' | '\u{6dd}' | '\u{70f}'
            | '\u{890}' | '\u{891}' | '\u{8e2}' | '\u{115f}' | '\u{1160}' | '\u{17b4}' | '\u{17b5}'
            | '\u{180b}'..='\u{180f}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}'
            | '\u{2060}'..='\u{206f}' | '\u{3164}' | '\u{fe00}'..='\u{fe0d}' | '\u{feff}' | '\u{ffa0}'
            | '\u{fff0}'..='\u{fffb}' | '\u{110bd}' | '\u{110cd}' | '\u{13430}'..='\u{1343f}'
            | '\u{1bca0}'..='\u{1bca3}' | '\u{1d173}'..='\u{1d17a}' | '\u{e0000}'..='\u{e0fff}')
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
        let words = "get me the „weiße“ bowl: 碗 🥣 ❤\u{fe0f}\n\tplease";
        assert_eq!(printable(words, &[]), words);
        assert_eq!(one_line("a\nb\tc"), "a\\nb\\tc");
        let hostile = "\x1b]0;title\x07 \x1b[2J \u{9b}31m \u{202e}abc \r\x7f";
        let clean = printable(hostile, &[]);
        assert_eq!(clean, "\\u{1b}]0;title\\u{7} \\u{1b}[2J \\u{9b}31m \\u{202e}abc \\r\\u{7f}");
        assert!(!clean.contains(is_hostile));
        let unseen = "bo\u{200b}wl \u{ad}\u{feff}\u{200d}\u{2062}\u{3164}\u{e0041}";
        let clean = one_line(unseen);
        assert_eq!(clean, "bo\\u{200b}wl \\u{ad}\\u{feff}\\u{200d}\\u{2062}\\u{3164}\\u{e0041}");
        let painted = "\x1b[31mno\x1b[0m \x1b[2J";
        assert_eq!(printable(painted, &["\x1b[31m", "\x1b[0m"]), "\x1b[31mno\x1b[0m \\u{1b}[2J");
    }

    #[test]
    fn escaped_json_means_the_same() {
        let all = (0..=0x2100).chain(0xfe00..=0x1_0000).chain(0xe_0000..=0xe_0100);
        for c in all.filter_map(char::from_u32) {
            let value = serde_json::json!({ "said": format!("a{c}b") });
            let line = printable_json(&value.to_string()).into_owned();
            assert!(!line.contains(is_hostile), "{line:?}");
            assert_eq!(serde_json::from_str::<serde_json::Value>(&line).unwrap(), value);
        }
    }
}
