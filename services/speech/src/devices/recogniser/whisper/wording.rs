//! From the model's tokens to a hypothesis, and from a scene to the text that the model is told to
//! go on from.

use scene::Scene;

use crate::devices::language_model;
use crate::devices::recogniser::Hypothesis;

/// A token of the model's: part of a word, with the blank before it where it begins one.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Piece {
    /// UTF-8, perhaps cut within a character.
    pub(super) bytes: Vec<u8>,
    /// Given the sound and what comes before, 0 to 1.
    pub(super) probability: f32,
}

/// What the pieces say, if anything. A word is as sure as all its pieces together; punctuation
/// counts for nothing, and remarks such as `[BLANK_AUDIO]` are left out. The library tells the best
/// text alone, so it has the whole weight.
pub(super) fn hypothesis(pieces: &[Piece]) -> Option<Hypothesis> {
    let mut words: Vec<(String, f32)> = Vec::new();
    let mut remark = false;
    for (raw, sure) in raw_words(pieces) {
        remark |= raw.starts_with(['[', '(']);
        if !remark {
            words.extend(language_model::words(&raw).into_iter().map(|word| (word, sure)));
        }
        remark &= !raw.contains([']', ')']);
    }
    let text = words.iter().map(|(word, _)| word.as_str()).collect::<Vec<_>>().join(" ");
    (!text.is_empty()).then_some(Hypothesis { text, confidence: 1.0, words })
}

/// The pieces from one blank to the next, put together.
fn raw_words(pieces: &[Piece]) -> Vec<(String, f32)> {
    let mut raw: Vec<(Vec<u8>, f32)> = Vec::new();
    for piece in pieces {
        let begins = piece.bytes.first().is_some_and(u8::is_ascii_whitespace);
        if begins || raw.is_empty() {
            raw.push((Vec::new(), 1.0));
        }
        let Some((bytes, sure)) = raw.last_mut() else { continue };
        bytes.extend_from_slice(piece.bytes.trim_ascii_start());
        if piece.bytes.iter().any(|b| b.is_ascii_alphanumeric() || !b.is_ascii()) {
            *sure *= piece.probability.clamp(0.0, 1.0);
        }
    }
    let text = |(bytes, sure): (Vec<u8>, f32)| (String::from_utf8_lossy(&bytes).into_owned(), sure);
    raw.into_iter().map(text).collect()
}

/// Longest prompt, bytes: half of the model's text holds some 220 tokens of 3 to 4 letters.
const PROMPT_MAX: usize = 600;

/// A text in which the scene's words occur, as somebody might say them: the model then prefers
/// them. Names that do not fit are left out, synonyms first.
pub(super) fn prompt(scene: &Scene) -> String {
    let values = || scene.attributes().iter().flat_map(|attribute| &attribute.values);
    let spoken = values().map(|value| &value.spoken);
    let synonyms = values().flat_map(|value| &value.synonyms);
    let mut text = format!("Yes. No. Get me the {}.", scene.noun());
    for name in spoken.chain(synonyms) {
        // The library takes text up to the first zero, and the binding refuses one.
        if text.len() + name.len() + 2 > PROMPT_MAX || name.contains('\0') {
            break;
        }
        text.push(' ');
        text.push_str(name);
        text.push('.');
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::devices::testing::{bowls, tools};

    fn pieces(told: &[(&str, f32)]) -> Vec<Piece> {
        let piece = |(text, probability): &(&str, f32)| Piece {
            bytes: text.as_bytes().to_vec(),
            probability: *probability,
        };
        told.iter().map(piece).collect()
    }

    #[test]
    fn a_word_is_as_sure_as_its_pieces_and_punctuation_counts_for_nothing() {
        let told = [(" The", 0.75), (" whi", 0.5), ("te", 0.5), (" one", 1.0), (".", 0.125)];
        let heard = hypothesis(&pieces(&told)).unwrap();
        assert_eq!((heard.text.as_str(), heard.confidence), ("the white one", 1.0));
        let words = [("the", 0.75), ("white", 0.25), ("one", 1.0)];
        assert_eq!(heard.words, words.map(|(word, sure)| (word.to_owned(), sure)));
    }

    #[test]
    fn words_keep_inner_hyphens_and_characters_that_were_cut() {
        let mut told = pieces(&[(" See", 1.0), ("-", 0.5), ("through", 1.0), (",", 1.0)]);
        told.push(Piece { bytes: b" caf\xc3".to_vec(), probability: 0.5 });
        told.push(Piece { bytes: b"\xa9!".to_vec(), probability: 0.5 });
        let heard = hypothesis(&told).unwrap();
        assert_eq!(heard.text, "see-through caf\u{e9}");
        assert_eq!(heard.words.iter().map(|w| w.1).collect::<Vec<_>>(), [1.0, 0.25]);
    }

    #[test]
    fn remarks_are_no_words() {
        assert_eq!(hypothesis(&pieces(&[(" [BLANK", 0.9), ("_AUDIO", 0.9), ("]", 0.9)])), None);
        let told =
            pieces(&[(" Yes", 0.9), (" (", 0.9), ("soft", 0.9), (" music", 0.9), (").", 0.9)]);
        assert_eq!(hypothesis(&told).unwrap().text, "yes");
        assert_eq!(hypothesis(&[]), None);
        assert_eq!(hypothesis(&pieces(&[(" ...", 0.9)])), None);
    }

    #[test]
    fn probabilities_out_of_range_stay_probabilities() {
        let heard = hypothesis(&pieces(&[(" no", 1.5), (" yes", -1.0)])).unwrap();
        assert_eq!(heard.words, [("no".to_owned(), 1.0), ("yes".to_owned(), 0.0)]);
    }

    #[test]
    fn the_prompt_has_the_scenes_names_and_is_bounded() {
        for scene in [bowls(), tools()] {
            let text = prompt(&scene);
            assert!(text.len() <= PROMPT_MAX, "{text}");
            for value in scene.attributes().iter().flat_map(|attribute| &attribute.values) {
                assert!(text.contains(&format!(" {}.", value.spoken)), "{text}: {}", value.spoken);
            }
        }
    }
}
