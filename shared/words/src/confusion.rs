//! Confusions between a scene's words, estimated by the similarity of their sounds.
//!
//! A word's spelling becomes a row of sounds: consonants in the classes of `phonetics.rs`, vowels
//! in three. The distance of two rows is the cost of the cheapest edit from one to the other,
//! divided by the cost of the rows themselves; of a value with synonyms the nearest pair counts.
//!
//! | step | cost |
//! |---|---|
//! | vowel for another vowel | 0.4 |
//! | consonant for one made alike (two stops, two hissing ones, two nasals, two liquids) | 0.5 |
//! | any other consonant for another | 1 |
//! | vowel, or `h`, `w`, `y`, left out or put in | 0.4 |
//! | any other consonant left out or put in | 0.7 |
//! | vowel for consonant | never: one is left out, the other put in |
//!
//! The costs are estimates. They rank pairs, and only the rank matters: `pen` is nearer to `red`
//! than to `screwdriver`.

use scene::Scene;

use crate::normalise::normalise;
use crate::phonetics::{is_vowel_letter, sound};
use crate::tokens::Tokens;

/// Share of each row that is divided evenly: confusions that sounds cannot explain.
const EVEN: f64 = 0.1;
/// Distance over which the rest of a row falls by the factor `e`. With it the nearest of the six
/// bowls' words gets between a quarter and nine tenths of its row.
const FALL: f64 = 0.15;
/// Extra distance of a synonym over the value's own name: fewer people say it.
const SYNONYM: f64 = 0.2;
/// Longest form of a value that is compared, in sounds.
const SOUNDS_MAX: usize = 48;

/// For each word of the scene (row) that was heard and not said, the probability that each word
/// (column) was said instead. The diagonal is 0 and a row sums to 1; a word that has no other has
/// a row of 0.
///
/// Each row gives nine tenths of its mass by likeness of sound and spreads the rest evenly.
pub fn confusion(scene: &Scene) -> Vec<Vec<f64>> {
    let sounds = forms(scene);
    let words = sounds.len();
    let mut likeness = vec![vec![0.0; words]; words];
    for heard in 0..words {
        for said in 0..heard {
            let like = (-distance(&sounds[heard], &sounds[said]) / FALL).exp();
            likeness[heard][said] = like;
            likeness[said][heard] = like;
        }
    }
    for (heard, row) in likeness.iter_mut().enumerate().filter(|_| words > 1) {
        let total: f64 = row.iter().sum();
        let even = EVEN / (words - 1) as f64;
        for (_, share) in row.iter_mut().enumerate().filter(|(said, _)| *said != heard) {
            *share = even + (1.0 - EVEN) * *share / total;
        }
    }
    likeness
}

/// The forms of each word of the scene, its name first, as sounds.
fn forms(scene: &Scene) -> Vec<Vec<Vec<Sound>>> {
    let mut forms = vec![Vec::new(); scene.words().len()];
    for value in scene.attributes().iter().flat_map(|attribute| &attribute.values) {
        for text in std::iter::once(&value.name).chain(&value.synonyms) {
            let sounds = sounds(text);
            let known: &mut Vec<Vec<Sound>> = &mut forms[value.word.index()];
            if !known.contains(&sounds) {
                known.push(sounds);
            }
        }
    }
    forms
}

/// One sound, with the properties that comparisons of many rows need.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Sound {
    /// A consonant in capitals, a vowel in small letters.
    heard: char,
    is_vowel: bool,
    /// Cost of deleting or inserting the sound.
    loss: f64,
    /// Class of consonants with the same manner of articulation.
    made: Option<usize>,
}

impl Sound {
    fn new(heard: char) -> Self {
        const ALIKE: [&str; 4] = ["PTK", "SXF0J", "MN", "LRW"];
        let is_vowel = heard.is_lowercase();
        let is_faint = is_vowel || matches!(heard, 'H' | 'W' | 'Y');
        let made = ALIKE.iter().position(|made| made.contains(heard));
        Self { heard, is_vowel, loss: if is_faint { 0.4 } else { 0.7 }, made }
    }
}

fn sounds(text: &str) -> Vec<Sound> {
    let text = normalise(text);
    let mut all: Vec<char> = Vec::new();
    for token in &Tokens::of(&text).words {
        word_sounds(token.word, &mut all);
    }
    all.truncate(SOUNDS_MAX);
    all.into_iter().map(Sound::new).collect()
}

fn word_sounds(word: &str, all: &mut Vec<char>) {
    if !word.bytes().all(|letter| letter.is_ascii_lowercase()) {
        // A number or a foreign letter sounds like itself alone.
        all.extend(word.chars());
        return;
    }
    // The "e" of "white" is not heard.
    let spoken = match word.strip_suffix('e') {
        Some(stem) if stem.bytes().any(is_vowel_letter) => stem,
        _ => word,
    };
    let letters = spoken.as_bytes();
    let mut at = 0;
    while at < letters.len() {
        let (consonant, length) = sound(&letters[at..], at == 0);
        let vowel = match letters[at] {
            b'e' | b'i' | b'y' => Some('e'),
            b'a' => Some('a'),
            b'o' | b'u' => Some('o'),
            _ => None,
        };
        let heard = if is_vowel_letter(letters[at]) { vowel } else { consonant.or(vowel) };
        // Letters that spell one sound together: "ee", "ou", "ll".
        let again = all.last().is_some_and(|last| {
            Some(*last) == heard || last.is_lowercase() && heard.is_some_and(char::is_lowercase)
        });
        all.extend(heard.filter(|_| at == 0 || !again));
        at += length;
    }
}

/// Returns the distance of the nearest forms of two words, 0 for the same sounds.
fn distance(one: &[Vec<Sound>], other: &[Vec<Sound>]) -> f64 {
    let rarity = |form: usize| if form == 0 { 0.0 } else { SYNONYM };
    let pairs = one.iter().enumerate().flat_map(|(n, one)| {
        other.iter().enumerate().map(move |(m, other)| relative(one, other) + rarity(n) + rarity(m))
    });
    pairs.fold(f64::INFINITY, f64::min).min(1.0)
}

/// The cost of turning one row of sounds into the other, by the mean cost of the rows.
fn relative(one: &[Sound], other: &[Sound]) -> f64 {
    let whole = |row: &[Sound]| row.iter().map(|sound| sound.loss).sum::<f64>();
    let mean = (whole(one) + whole(other)) / 2.0;
    if mean > 0.0 { edits(one, other) / mean } else { 0.0 }
}

/// The weighted edit distance (Wagner and Fischer 1974).
fn edits(one: &[Sound], other: &[Sound]) -> f64 {
    let mut row: Vec<f64> = std::iter::once(0.0)
        .chain(other.iter().scan(0.0, |sum, sound| {
            *sum += sound.loss;
            Some(*sum)
        }))
        .collect();
    for a in one {
        let mut diagonal = row[0];
        row[0] += a.loss;
        for (at, b) in other.iter().enumerate() {
            let best = (diagonal + swap(a, b)).min(row[at] + b.loss).min(row[at + 1] + a.loss);
            diagonal = std::mem::replace(&mut row[at + 1], best);
        }
    }
    row.last().copied().unwrap_or(0.0)
}

/// Returns the cost of substituting one sound for another.
fn swap(a: &Sound, b: &Sound) -> f64 {
    match (a.is_vowel, b.is_vowel) {
        _ if a.heard == b.heard => 0.0,
        (true, true) => 0.4,
        (false, false) if a.made.is_some() && a.made == b.made => 0.5,
        (false, false) => 1.0,
        _ => a.loss + b.loss,
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;
    use scene::Scene;

    use super::{confusion, edits, sounds};

    fn scene(name: &str) -> Scene {
        let text = match name {
            "bowls" => include_str!("../../../config/scenes/bowls.toml"),
            _ => include_str!("../../../config/scenes/tools.toml"),
        };
        Scene::from_toml(name, text).expect("a scene")
    }

    fn nearest(scene: &Scene, heard: &str) -> String {
        let row = &confusion(scene)[scene.word_named(heard).expect("a word").index()];
        let best = (0..row.len()).max_by(|&a, &b| row[a].total_cmp(&row[b])).expect("words");
        scene.words()[best].clone()
    }

    #[test]
    fn confusion_rows_are_distributions_over_the_other_words() {
        for scene in ["bowls", "tools"].map(scene) {
            let rows = confusion(&scene);
            assert_eq!(rows.len(), scene.words().len());
            let floor = 0.1 / (rows.len() - 1) as f64;
            for (heard, row) in rows.iter().enumerate() {
                assert_eq!(row.len(), rows.len());
                assert_eq!(row[heard], 0.0);
                assert!((row.iter().sum::<f64>() - 1.0).abs() < 1e-12);
                let others = row.iter().enumerate().filter(|(said, _)| *said != heard);
                assert!(others.map(|(_, share)| *share).all(|share| share >= floor));
            }
        }
    }

    #[test]
    fn confusion_is_largest_between_similar_sounds() {
        let (bowls, tools) = (scene("bowls"), scene("tools"));
        for (scene, heard, said) in
            [(&bowls, "metal", "metallic"), (&bowls, "metallic", "metal"), (&tools, "pen", "green")]
        {
            assert_eq!(nearest(scene, heard), said, "{heard}");
        }
        let like = |a: &str, b: &str| edits(&sounds(a), &sounds(b));
        assert_eq!(like("white", "wide"), 0.0);
        assert_eq!(like("red", "read"), 0.0);
        assert!(like("pen", "pan") < like("pen", "red"));
        assert!(like("marker", "market") < like("marker", "hammer"));
        assert!(like("pen", "red") < like("pen", "screwdriver"));
    }

    #[test]
    fn confusion_row_of_a_single_word_is_empty() {
        let json = serde_json::json!({"objects": [{"name": "a", "attributes": {"k": "7"}}],
            "values": {"k": ["7"]}});
        let scene = Scene::from_json("one", &json).expect("a scene");
        assert_eq!(confusion(&scene), [[0.0]]);
    }

    proptest! {
        #[test]
        fn the_distance_is_one(a in "[a-z ]{0,12}", b in "[a-z0-9 ]{0,12}", c in "\\PC{0,8}") {
            let [a, b, c] = [a, b, c].map(|text| sounds(&text));
            prop_assert_eq!(edits(&a, &a), 0.0);
            prop_assert!((edits(&a, &b) - edits(&b, &a)).abs() < 1e-12);
            prop_assert!(edits(&a, &c) <= edits(&a, &b) + edits(&b, &c) + 1e-12);
        }
    }
}
