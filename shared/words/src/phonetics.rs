//! Coarse phonetic forms of words, for words that a recogniser took for others ("wide" for "white",
//! "mettle" for "metal").

/// The consonants of a word as classes that recognisers confuse, voicing and spelling aside:
/// "white" and "wide" are both `WT`. `None` for words with anything but ASCII letters.
pub fn skeleton(word: &str) -> Option<String> {
    let letters = word.as_bytes();
    if letters.is_empty() || !letters.iter().all(u8::is_ascii_lowercase) {
        return None;
    }
    let mut sounds = String::with_capacity(letters.len());
    let mut at = 0;
    while at < letters.len() {
        let (sound, length) = sound(&letters[at..], at == 0);
        if let Some(sound) = sound
            && !sounds.ends_with(sound)
        {
            sounds.push(sound);
        }
        at += length;
    }
    Some(sounds)
}

/// Returns whether a letter usually spells a vowel.
pub(crate) fn is_vowel_letter(letter: u8) -> bool {
    matches!(letter, b'a' | b'e' | b'i' | b'o' | b'u')
}

/// The first sound of some letters, if it is a consonant, and how many letters spell it.
pub(crate) fn sound(letters: &[u8], initial: bool) -> (Option<char>, usize) {
    let two = letters.get(..2).unwrap_or_default();
    match two {
        b"wr" | b"kn" if initial => return (Some(if two == b"wr" { 'R' } else { 'N' }), 2),
        b"wh" => return (Some('W'), 2),
        b"gh" => return (None, 2),
        b"ph" => return (Some('F'), 2),
        b"ck" => return (Some('K'), 2),
        b"sh" | b"ch" => return (Some('X'), 2),
        b"th" => return (Some('0'), 2),
        _ => {}
    }
    let sound = match letters[0] {
        b'b' | b'p' => 'P',
        b'd' | b't' => 'T',
        b'g' | b'k' | b'q' | b'x' => 'K',
        b'c' if matches!(letters.get(1), Some(b'e' | b'i' | b'y')) => 'S',
        b'c' => 'K',
        b'f' | b'v' => 'F',
        b's' | b'z' => 'S',
        b'j' => 'J',
        b'l' => 'L',
        b'm' => 'M',
        b'n' => 'N',
        b'r' => 'R',
        b'w' if initial => 'W',
        b'h' if initial => 'H',
        b'y' if initial => 'Y',
        _ if initial => 'A',
        _ => return (None, 1),
    };
    (Some(sound), 1)
}

#[cfg(test)]
mod tests {
    use super::skeleton;

    #[test]
    fn confusable_words_share_a_skeleton() {
        for (said, heard) in [
            ("white", "wide"),
            ("red", "read"),
            ("blue", "blew"),
            ("metal", "medal"),
            ("metal", "mettle"),
            ("wrench", "ranch"),
            ("small", "smell"),
            ("black", "block"),
            ("pen", "pin"),
            ("white", "wight"),
        ] {
            assert_eq!(skeleton(said), skeleton(heard), "{said} {heard}");
        }
        assert_ne!(skeleton("white"), skeleton("why"));
        assert_ne!(skeleton("red"), skeleton("green"));
        assert_eq!(skeleton("weiß"), None);
    }
}
