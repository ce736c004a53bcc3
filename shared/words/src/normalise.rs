//! Text as it arrives to text as it is read: lower case, plain letters, plain punctuation.

use std::borrow::Cow;

use unicode_normalization::UnicodeNormalization;
use unicode_normalization::char::is_combining_mark;

/// Largest length of an utterance that is read, in characters. Twenty minutes of speech fit; the
/// bound keeps a pasted book from occupying the reader.
pub const TEXT_CHARS_MAX: usize = 16_384;

/// Lower-cases, takes letters apart from their accents, maps typographic quotes and dashes to
/// plain ones, drops invisible characters, and spells out the emoji that answer a question.
pub fn normalise(text: &str) -> Cow<'_, str> {
    if text.is_ascii() {
        let text = &text[..text.len().min(TEXT_CHARS_MAX)];
        return match text.bytes().any(|byte| byte.is_ascii_uppercase()) {
            true => Cow::Owned(text.to_ascii_lowercase()),
            false => Cow::Borrowed(text),
        };
    }
    let mut plain = String::with_capacity(text.len().min(TEXT_CHARS_MAX * 2));
    // A lone accent is typed for an apostrophe; its compatibility form would split the word.
    let chars = text.chars().map(|c| if c == '\u{00b4}' { '\'' } else { c });
    // Compatibility forms first (full-width letters, ligatures, ellipsis), then each on its own.
    for c in chars.take(TEXT_CHARS_MAX).nfkd().take(TEXT_CHARS_MAX) {
        match c {
            '\u{2018}' | '\u{2019}' | '\u{201b}' | '\u{02bc}' | '\u{2032}' => plain.push('\''),
            '\u{2010}' | '\u{2011}' => plain.push('-'),
            '\u{2012}'..='\u{2015}' => plain.push_str(" , "),
            '\u{3002}' | '\u{061f}' => plain.push_str(" . "),
            '\u{1f44d}' | '\u{2705}' | '\u{2714}' | '\u{1f197}' => plain.push_str(" yes "),
            '\u{1f44e}' | '\u{274c}' | '\u{2716}' => plain.push_str(" no "),
            c if is_invisible(c) || is_combining_mark(c) => {}
            c => plain.extend(c.to_lowercase()),
        }
    }
    Cow::Owned(plain)
}

/// Format characters that show nothing and must not split a word.
fn is_invisible(c: char) -> bool {
    matches!(c, '\u{00ad}' | '\u{200b}'..='\u{200f}' | '\u{202a}'..='\u{202e}'
        | '\u{2060}'..='\u{2064}' | '\u{feff}' | '\u{fe00}'..='\u{fe0f}')
}

#[cfg(test)]
mod tests {
    use super::{TEXT_CHARS_MAX, normalise};

    #[test]
    fn normalise_removes_typography() {
        for (text, plain) in [
            ("The BIG bowl", "the big bowl"),
            ("isn\u{2019}t", "isn't"),
            ("isn\u{b4}t", "isn't"),
            ("ｗｈｉｔｅ", "white"),
            ("𝐰𝐡𝐢𝐭𝐞", "white"),
            ("w\u{200b}hi\u{ad}te", "white"),
            ("cliché", "cliche"),
            ("red\u{2014}no", "red , no"),
            ("\u{1f44d}\u{1f3fd}", " yes \u{1f3fd}"),
            ("İ", "i"),
        ] {
            assert_eq!(normalise(text), plain);
        }
    }

    #[test]
    fn normalise_bounds_the_length() {
        assert_eq!(normalise(&"a".repeat(1 << 20)).len(), TEXT_CHARS_MAX);
        // One character that decomposes into eighteen.
        let long = normalise(&"\u{fdfa}".repeat(1 << 20)).chars().count();
        assert!(long <= TEXT_CHARS_MAX);
    }
}
