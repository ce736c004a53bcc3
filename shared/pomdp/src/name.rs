//! Names that the format can hold, made of any text and readable back.
//!
//! An identifier of the format is a letter followed by letters, digits, `_` and `-`. A name here is
//! a kind and the texts that it is about, joined by `__`: `is__color__white`. In the texts, ASCII
//! letters, digits and `-` stand for themselves and every other byte of their UTF-8 form is written
//! `_` and two hexadecimal digits: `is__made_20of__caf_c3_a9`. As `_` itself is written `_5f`, `__`
//! appears between parts alone, and no two names are written alike.

/// The identifier of a kind and texts.
///
/// The kind must be an identifier without `_`.
pub fn escape(kind: &str, texts: &[&str]) -> String {
    let mut name = kind.to_owned();
    for text in texts {
        name += "__";
        for byte in text.bytes() {
            if byte.is_ascii_alphanumeric() || byte == b'-' {
                name.push(char::from(byte));
            } else {
                name += &format!("_{byte:02x}");
            }
        }
    }
    name
}

/// The kind and texts of an identifier; nothing for one that [`escape`] does not write.
pub fn unescape(name: &str) -> Option<(String, Vec<String>)> {
    let mut parts = vec![Vec::new()];
    let mut rest = name.as_bytes();
    while let Some((&byte, after)) = rest.split_first() {
        rest = after;
        if byte != b'_' {
            parts.last_mut()?.push(byte);
        } else if let Some(after) = rest.strip_prefix(b"_") {
            parts.push(Vec::new());
            rest = after;
        } else {
            let (digits, after) = rest.split_at_checked(2)?;
            let byte = u8::from_str_radix(str::from_utf8(digits).ok()?, 16).ok()?;
            parts.last_mut()?.push(byte);
            rest = after;
        }
    }
    let texts = parts.into_iter().map(|part| String::from_utf8(part).ok());
    let mut texts: Vec<String> = texts.collect::<Option<_>>()?;
    let kind = texts.remove(0);
    let references: Vec<&str> = texts.iter().map(String::as_str).collect();
    (escape(&kind, &references) == name).then_some((kind, texts))
}

#[cfg(test)]
mod tests {
    use super::*;
    use dialogue::Rng;

    #[test]
    fn plain_names_stay_readable() {
        assert_eq!(escape("wait", &[]), "wait");
        assert_eq!(escape("is", &["color", "see-through"]), "is__color__see-through");
        assert_eq!(escape("pick", &["my_bowl 2"]), "pick__my_5fbowl_202");
        assert_eq!(escape("says", &["größe", ""]), "says__gr_c3_b6_c3_9fe__");
    }

    #[test]
    fn any_texts_come_back_and_are_told_apart() {
        let mut rng = Rng::new(31);
        let letters: Vec<char> = "ab_-_ 5f:#*\n\u{e9}\u{1f600}".chars().collect();
        let mut names = std::collections::HashMap::new();
        for _ in 0..5_000 {
            let mut text = || -> String {
                (0..rng.below(4)).map(|_| letters[rng.below(letters.len())]).collect()
            };
            let texts = [text(), text()];
            let name = escape("is", &[&texts[0], &texts[1]]);
            assert!(name.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_' || b == b'-'));
            assert_eq!(unescape(&name), Some(("is".to_owned(), texts.to_vec())), "{name}");
            let before = names.insert(name.clone(), texts.clone());
            assert!(before.is_none_or(|before| before == texts), "{name}");
        }
    }

    #[test]
    fn what_was_not_written_here_is_not_read() {
        for wrong in ["a_", "a_5", "a_zz", "a_5F", "a__b_41", "a__\u{e9}", "a__b_ff", "a__b_+1"] {
            assert_eq!(unescape(wrong), None, "{wrong}");
        }
    }
}
