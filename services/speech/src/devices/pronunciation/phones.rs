//! espeak-ng's phoneme names (`espeak-ng -x`, voice `en-us`) in the forty phones of the acoustic
//! model, which are those of the CMU pronouncing dictionary.

const PHONES: &[(&str, &str)] = &[
    // Consonants; `t#` and `t2` are flapped, `n-`, `r-` and `l-` syllabic.
    ("p", "P"),
    ("b", "B"),
    ("t", "T"),
    ("t#", "T"),
    ("t2", "T"),
    ("d", "D"),
    ("k", "K"),
    ("x", "K"),
    ("g", "G"),
    ("f", "F"),
    ("v", "V"),
    ("T", "TH"),
    ("D", "DH"),
    ("s", "S"),
    ("z", "Z"),
    ("S", "SH"),
    ("Z", "ZH"),
    ("tS", "CH"),
    ("dZ", "JH"),
    ("h", "HH"),
    ("m", "M"),
    ("n", "N"),
    ("n-", "AH N"),
    ("N", "NG"),
    ("l", "L"),
    ("l-", "AH L"),
    ("r", "R"),
    ("r-", "R"),
    ("w", "W"),
    ("j", "Y"),
    // Vowels and diphthongs; those with `@` or `3` behind carry an American r.
    ("a", "AE"),
    ("aa", "AE"),
    ("a#", "AH"),
    ("A", "AA"),
    ("A:", "AA"),
    ("A@", "AA R"),
    ("0", "AA"),
    ("O2", "AA"),
    ("O", "AO"),
    ("O:", "AO"),
    ("O@", "AO R"),
    ("o@", "AO R"),
    ("E", "EH"),
    ("E#", "EH"),
    ("e@", "EH R"),
    ("3", "ER"),
    ("3:", "ER"),
    ("@", "AH"),
    ("@-", "AH"),
    ("@2", "AH"),
    ("@5", "AH"),
    ("@L", "AH L"),
    ("V", "AH"),
    ("I", "IH"),
    ("I#", "IH"),
    ("I2", "IH"),
    ("i", "IY"),
    ("i:", "IY"),
    ("i@", "IY AH"),
    ("i@3", "IH R"),
    ("U", "UH"),
    ("U@", "UH R"),
    ("u", "UW"),
    ("u:", "UW"),
    ("eI", "EY"),
    ("aI", "AY"),
    ("aI@", "AY AH"),
    ("aI3", "AY ER"),
    ("aU", "AW"),
    ("aU3", "AW ER"),
    ("OI", "OY"),
    ("oU", "OW"),
];

/// The phones of a line of phoneme names separated by blanks. `None` where a name is not known:
/// half a pronunciation would be worse than none.
pub(super) fn phones(espeak: &str) -> Option<String> {
    let mut phones = Vec::new();
    for token in espeak.split_whitespace() {
        let name = token.trim_start_matches(['\'', ',', '%', '=']);
        // Marks of pauses, glottal stops and palatal off-glides have no phone of their own.
        if name.is_empty() || matches!(name, ";" | "?" | "_" | "_:" | "_|" | "|" | "||") {
            continue;
        }
        phones.push(PHONES.iter().find(|(from, _)| *from == name)?.1);
    }
    (!phones.is_empty()).then(|| phones.join(" "))
}

#[cfg(test)]
mod tests {
    use super::phones;

    #[test]
    fn known_phonemes_become_phones_without_stress() {
        assert_eq!(phones("w '3: k t2 0 p").as_deref(), Some("W ER K T AA P"));
        assert_eq!(phones("'E k s a# l 'aI n d\n").as_deref(), Some("EH K S AH L AY N D"));
    }

    #[test]
    fn an_unknown_phoneme_yields_nothing() {
        assert_eq!(phones("b y: 9"), None);
        assert_eq!(phones(" _: "), None);
    }
}
