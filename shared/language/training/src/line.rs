//! Reading of labelled lines.

use language::Polarity;

/// A labelled line.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Line {
    /// Name of the line's scene.
    pub scene: String,
    /// The robot's question before it, in words; empty for none.
    pub question: String,
    /// The speaker's act: `want`, `yes`, `no`, `unsure`, `stop`, `cancel`, `ask`, `talk`, `other`.
    pub act: String,
    /// The words, without marks.
    pub text: String,
    /// The value words in their order.
    pub marked: Vec<Marked>,
}

/// A labelled value word.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Marked {
    /// The words as written in the text.
    pub surface: String,
    /// Polarity of the value: wanted, denied or neither.
    pub polarity: Polarity,
}

/// Reads the lines of a file; `name` is that of the file, for errors.
///
/// # Errors
/// The first line that is not of this form, in a sentence.
pub fn lines(name: &str, text: &str) -> Result<Vec<Line>, String> {
    let is_line = |(_, line): &(usize, &str)| !line.is_empty() && !line.starts_with('#');
    let read = |(at, line): (usize, &str)| {
        Line::read(line).map_err(|why| format!("{name}:{}: {why}", at + 1))
    };
    text.lines().map(str::trim).enumerate().filter(is_line).map(read).collect()
}

impl Line {
    fn read(line: &str) -> Result<Self, String> {
        let fields: Vec<&str> = line.splitn(4, " | ").collect();
        let [scene, question, act, utterance] = fields[..] else {
            return Err(format!("expected 4 fields, found {}", fields.len()));
        };
        let question = if question == "-" { "" } else { question };
        let (mut text, mut marked) = (String::new(), Vec::new());
        let mut rest = utterance;
        while let Some((before, mark)) = rest.split_once('[') {
            let (mark, after) = mark.split_once(']').ok_or("expected \"]\", found none")?;
            let found = Marked::read(mark).ok_or_else(|| format!("expected a sign in [{mark}]"))?;
            text += before;
            text += &found.surface;
            marked.push(found);
            rest = after;
        }
        text += rest;
        let [scene, question, act] = [scene, question, act].map(str::to_owned);
        Ok(Self { scene, question, act, text, marked })
    }
}

impl Marked {
    fn read(mark: &str) -> Option<Self> {
        let polarity = polarity(mark.chars().last()?)?;
        Some(Self { surface: mark[..mark.len() - 1].to_owned(), polarity })
    }
}

/// Returns the polarity denoted by a sign.
pub(crate) fn polarity(sign: char) -> Option<Polarity> {
    match sign {
        '+' => Some(Polarity::Wanted),
        '-' => Some(Polarity::Denied),
        '0' => Some(Polarity::Neither),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn line_without_marks_is_what_was_said() {
        let read = lines(
            "a.txt",
            "# a comment\ntools | Is it red? | want | no, [blue+] and not [red-].\n",
        );
        let line = &read.unwrap()[0];
        assert_eq!((&*line.scene, &*line.question, &*line.act), ("tools", "Is it red?", "want"));
        assert_eq!(line.text, "no, blue and not red.");
        let marked = |surface: &str, polarity| Marked { surface: surface.into(), polarity };
        let expected = [marked("blue", Polarity::Wanted), marked("red", Polarity::Denied)];
        assert_eq!(line.marked, expected);
        for wrong in ["tools | - | want", "tools | - | want | [red", "tools | - | want | [red]"] {
            assert!(lines("a.txt", wrong).unwrap_err().starts_with("a.txt:1: expected"), "{wrong}");
        }
    }
}
