//! Identifiers of the format, made of any text and readable back.
//!
//! An identifier of the format is a letter followed by letters, digits, `_` and `-`. A name here is
//! a kind and its texts, joined by `__`: `is__color__white`. In the texts, ASCII letters, digits
//! and `-` are unchanged; every other byte of their UTF-8 form is written as `_` and two
//! hexadecimal digits: `is__made_20of__caf_c3_a9`. As `_` itself is written `_5f`, `__` appears
//! only between parts, and no two names are written alike.

/// Returns the identifier of a kind, itself an identifier without `_`, and its texts.
pub(super) fn escape(kind: &str, texts: &[&str]) -> String {
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

#[cfg(test)]
mod tests {
    use vocabulary::Rng;

    use super::*;

    #[test]
    fn escape_keeps_plain_names_readable() {
        assert_eq!(escape("wait", &[]), "wait");
        assert_eq!(escape("is", &["color", "see-through"]), "is__color__see-through");
        assert_eq!(escape("pick", &["my_bowl 2"]), "pick__my_5fbowl_202");
        assert_eq!(escape("says", &["größe", ""]), "says__gr_c3_b6_c3_9fe__");
    }

    /// Reads the bytes of a text back.
    fn unescape(text: &str) -> Vec<u8> {
        let mut parts = text.split('_');
        let mut bytes = parts.next().unwrap().as_bytes().to_vec();
        for part in parts {
            bytes.push(u8::from_str_radix(&part[..2], 16).unwrap());
            bytes.extend(part[2..].bytes());
        }
        bytes
    }

    #[test]
    fn escape_gives_identifiers_that_are_read_back() {
        let seed = 31;
        let mut rng = Rng::new(seed);
        let letters: Vec<char> = "ab_-_ 5f:#*\n\u{e9}\u{1f600}".chars().collect();
        for _ in 0..5_000 {
            let mut text = || -> String {
                (0..rng.below(4)).map(|_| letters[rng.below(letters.len())]).collect()
            };
            let texts = [text(), text()];
            let name = escape("is", &[&texts[0], &texts[1]]);
            assert!(name.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_' || b == b'-'));
            let read: Vec<_> = name.split("__").skip(1).map(unescape).collect();
            assert_eq!(read, texts.map(String::into_bytes), "seed {seed}: {name}");
        }
    }
}
