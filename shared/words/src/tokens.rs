//! Normalised text to words: contractions opened ("isn't" is "is not"), compounds split at their
//! hyphens, punctuation kept as a pause.

use std::collections::HashMap;
use std::sync::LazyLock;

/// The pause before a word.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Gap {
    /// Written with a hyphen to the word before.
    Glued,
    /// A space.
    None,
    /// A comma, dash, colon, bracket or suspension points.
    Pause,
    /// The end of a sentence.
    Stop,
}

/// A word and the gap before it in the text.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Token<'a> {
    /// Letters and digits, in lower case.
    pub word: &'a str,
    /// Pause before the word.
    pub gap: Gap,
    /// Probability that the word was said.
    pub confidence: f32,
}

impl Token<'_> {
    /// Returns whether there is a pause before it.
    pub fn pauses(&self) -> bool {
        self.gap >= Gap::Pause
    }
}

/// The words of a text.
#[derive(Debug, Default)]
pub struct Tokens<'a> {
    /// The words, in order.
    pub words: Vec<Token<'a>>,
    /// Braces, tags or shell characters, which do not occur in speech.
    pub code: bool,
}

impl<'a> Tokens<'a> {
    /// Splits a normalised text of which every word is certain.
    pub fn of(text: &'a str) -> Self {
        Self::heard(text, &[])
    }

    /// Splits a normalised text; `confidence` is by blank-separated word, those beyond it certain.
    pub fn heard(text: &'a str, confidence: &[f32]) -> Self {
        let mut tokens =
            Self { words: Vec::with_capacity(text.len() / 5 + 1), code: is_code(text) };
        let mut gap = Gap::Stop;
        let mut rest = text;
        let (mut blanks, mut inside) = (0, false);
        while let Some(c) = rest.chars().next() {
            if c.is_whitespace() {
                blanks += usize::from(inside);
            }
            inside = !c.is_whitespace();
            let sure = confidence.get(blanks).map_or(1.0, |sure| sure.clamp(0.0, 1.0));
            let end = if c.is_alphanumeric() { word_end(rest) } else { 0 };
            if end > 0 {
                let (word, after) = rest.split_at(end);
                tokens.push_word(word, gap, sure);
                rest = after;
                gap = Gap::None;
                if let Some(after) = hyphenated(rest) {
                    rest = after;
                    gap = Gap::Glued;
                }
                continue;
            }
            let (pause, len) = pause(rest, c);
            gap = gap.max(Gap::None).max(pause);
            rest = &rest[len..];
        }
        tokens
    }

    fn push_word(&mut self, word: &'a str, mut gap: Gap, confidence: f32) {
        let mut push = |word: &'a str| {
            if !word.is_empty() {
                self.words.push(Token { word, gap, confidence });
                gap = Gap::None;
            }
        };
        if let Some(expanded) = expansion(word) {
            expanded.split(' ').for_each(push);
            return;
        }
        let Some(quote) = word.rfind('\'') else { return push(word) };
        let (stem, ending) = word.split_at(quote);
        match ending {
            "'t" if stem.ends_with('n') => {
                push(&stem[..stem.len() - 1]);
                push("not");
            }
            "'re" => [stem, "are"].into_iter().for_each(push),
            "'ve" => [stem, "have"].into_iter().for_each(push),
            "'ll" => [stem, "will"].into_iter().for_each(push),
            "'d" => [stem, "would"].into_iter().for_each(push),
            "'m" => [stem, "am"].into_iter().for_each(push),
            "'s" if takes_is(stem) => [stem, "is"].into_iter().for_each(push),
            "'s" => push(stem),
            _ => word.split('\'').for_each(push),
        }
    }
}

/// Returns the words of a contraction that its ending does not spell out.
fn expansion(word: &str) -> Option<&'static str> {
    static EXPANSIONS: LazyLock<HashMap<&str, &str>> = LazyLock::new(|| contractions().collect());
    EXPANSIONS.get(word).copied()
}

/// Returns the contractions that their ending does not spell out, each with its words.
pub fn contractions() -> impl Iterator<Item = (&'static str, &'static str)> {
    let lines = include_str!("contractions.txt").lines();
    let rows = lines.filter_map(|line| line.split_once(" = "));
    rows.flat_map(|(words, expansion)| words.split(", ").map(move |word| (word, expansion)))
}

/// Returns whether "…'s" is "… is" and not a possessive.
fn takes_is(stem: &str) -> bool {
    const STEMS: &str =
        "it that this there here what where who which how he she one everything nothing";
    STEMS.split(' ').any(|listed| listed == stem)
}

/// End of the word that starts `text`: letters and digits, apostrophes between letters, and marks
/// between digits: "2.5", "9:15", "7/8".
fn word_end(text: &str) -> usize {
    let mut end = 0;
    let mut before = ' ';
    let mut chars = text.char_indices().peekable();
    while let Some((at, c)) = chars.next() {
        let next = chars.peek().map_or(' ', |(_, next)| *next);
        let joins = match c {
            '\'' => at > 0 && next.is_alphabetic(),
            '.' | ',' | ':' | '/' => before.is_numeric() && next.is_numeric(),
            c => c.is_alphanumeric(),
        };
        if !joins {
            break;
        }
        (before, end) = (c, at + c.len_utf8());
    }
    end
}

/// Returns the part after a hyphen that joins two words.
fn hyphenated(text: &str) -> Option<&str> {
    text.strip_prefix('-').filter(|after| after.starts_with(char::is_alphanumeric))
}

/// Returns the pause for a character, and the character's length in bytes.
fn pause(text: &str, c: char) -> (Gap, usize) {
    match c {
        '.' => {
            let dots = text.bytes().take_while(|byte| *byte == b'.').count();
            (if dots > 1 { Gap::Pause } else { Gap::Stop }, dots)
        }
        '!' | '?' => (Gap::Stop, 1),
        ',' | ';' | ':' | '(' | ')' | '[' | ']' | '"' | '/' | '|' | '\n' => (Gap::Pause, 1),
        '-' if text.starts_with("- ") || text.starts_with("--") => (Gap::Pause, 1),
        c => (Gap::None, c.len_utf8()),
    }
}

fn is_code(text: &str) -> bool {
    let tag = |at: usize| {
        text[at + 1..].starts_with(|c: char| c.is_ascii_alphabetic() || c == '/' || c == '|')
    };
    // A backslash alone may be part of a face: "¯\_(ツ)_/¯".
    let joins = |at: usize| {
        text[..at].ends_with(char::is_alphabetic) && text[at + 1..].starts_with(char::is_alphabetic)
    };
    let escape = |at: usize| text[at + 1..].starts_with(|c: char| c.is_ascii_alphanumeric());
    text.contains(['{', '}', '`'])
        || text.match_indices('\\').any(|(at, _)| escape(at))
        || ["://", "[/", "()", "=="].iter().any(|mark| text.contains(mark))
        || text.match_indices('_').any(|(at, _)| joins(at))
        || text.contains("$(")
        || text.match_indices('<').any(|(at, _)| tag(at))
}

#[cfg(test)]
mod tests {
    use super::{Gap, Tokens};

    fn words(text: &str) -> Vec<&str> {
        Tokens::of(text).words.iter().map(|token| token.word).collect()
    }

    #[test]
    fn tokens_expand_contractions() {
        for (text, opened) in [
            ("isn't it", "is not it"),
            ("can't i won't", "can not i will not"),
            ("that's what i'd like", "that is what i would like"),
            ("my mother's bowl", "my mother bowl"),
            ("dont", "do not"),
            ("rock'n'roll", "rock n roll"),
            ("'white'", "white"),
            ("the 2.5 l one. 3 of them", "the 2.5 l one 3 of them"),
            ("v1.2, 9:15, 7/8.", "v1.2 9:15 7/8"),
            ("red/blue:dr.lee", "red blue dr lee"),
        ] {
            assert_eq!(words(text).join(" "), opened);
        }
    }

    #[test]
    fn token_confidences_follow_the_blanks() {
        let confidence = [0.9, 0.5, 0.8];
        let sure = |text| -> Vec<f32> {
            Tokens::heard(text, &confidence).words.iter().map(|token| token.confidence).collect()
        };
        assert_eq!(sure("the white bowl"), [0.9, 0.5, 0.8]);
        assert_eq!(sure("  the   see-through bowl now"), [0.9, 0.5, 0.5, 0.8, 1.0]);
        assert_eq!(sure("isn't it"), [0.9, 0.9, 0.5]);
        assert_eq!(Tokens::heard("no", &[f32::NAN]).words.len(), 1);
    }

    #[test]
    fn tokens_keep_punctuation_as_pauses() {
        let tokens = Tokens::of("red, no... blue-ish. yes");
        let gaps: Vec<Gap> = tokens.words.iter().map(|token| token.gap).collect();
        assert_eq!(gaps, [Gap::Stop, Gap::Pause, Gap::Pause, Gap::Glued, Gap::Stop]);
        assert!(words("... ?! --").is_empty());
    }

    #[test]
    fn tokens_recognise_code_but_not_emoticons() {
        assert!(Tokens::of("{\"base\":[]}").code);
        assert!(Tokens::of("<script>").code);
        assert!(!Tokens::of("the white one <3 thanks").code);
    }
}
