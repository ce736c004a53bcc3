//! Lines with a slip in one word that is not a value: their meaning stays the same.

use std::ops::Range;

use vocabulary::Rng;

use crate::line::Line;

/// Fewest letters of a word that is spoilt: shorter ones become other words.
const LETTERS_MIN: usize = 3;

/// Returns the line with a typing error in a word that is not a value, if it has such a word.
pub fn with_typo(line: &Line, random: &mut Rng) -> Option<Line> {
    let words = plain_words(line);
    let place = words.get(random.below(words.len().max(1)))?.clone();
    let mut letters: Vec<char> = line.text[place.clone()].chars().collect();
    let at = random.below(letters.len() - 1);
    let is_swap = random.below(2) == 0 && letters[at] != letters[at + 1];
    match (is_swap, random.below(2)) {
        (true, _) => letters.swap(at, at + 1),
        (false, 0) => drop(letters.remove(at)),
        (false, _) => letters.insert(at, letters[at + 1]),
    }
    let mut text = line.text.clone();
    text.replace_range(place, &letters.into_iter().collect::<String>());
    Some(Line { text, ..line.clone() })
}

/// Returns the positions of words that are not values.
fn plain_words(line: &Line) -> Vec<Range<usize>> {
    let mut values = Vec::new();
    let mut from = 0;
    for marked in &line.marked {
        if let Some(at) = line.text[from..].find(&marked.surface) {
            values.push(from + at..from + at + marked.surface.len());
            from += at + marked.surface.len();
        }
    }
    let mut words = Vec::new();
    let mut start = 0;
    let is_letter = |c: char| c.is_alphabetic() || c == '\'';
    for (at, letter) in line.text.char_indices().chain([(line.text.len(), ' ')]) {
        if is_letter(letter) {
            continue;
        }
        let word = start..at;
        start = at + letter.len_utf8();
        let is_value = values.iter().any(|it| it.start < word.end && word.start < it.end);
        let is_long =
            word.end > word.start && line.text[word.clone()].chars().count() >= LETTERS_MIN;
        if is_long && !is_value {
            words.push(word);
        }
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slip_spoils_one_word_and_no_value() {
        let read = crate::lines("a.txt", "tools | - | want | get me not [the red-] one\n").unwrap();
        let mut random = Rng::new(1);
        let mut spoilt = std::collections::BTreeSet::new();
        for _ in 0..100 {
            let slip = with_typo(&read[0], &mut random).unwrap();
            assert!(slip.text.contains(" the red ") && slip.text.contains(" me "), "{}", slip.text);
            let words = slip.text.split(' ').zip(read[0].text.split(' '));
            let mut changed = words.filter(|(one, other)| one != other).map(|(_, other)| other);
            spoilt.extend(changed.next());
            assert_eq!(changed.next(), None, "{}", slip.text);
        }
        assert_eq!(spoilt.into_iter().collect::<Vec<_>>(), ["get", "not", "one"]);
        let values = crate::lines("a.txt", "tools | - | want | [red+] me\n").unwrap();
        assert_eq!(with_typo(&values[0], &mut random), None);
    }
}
