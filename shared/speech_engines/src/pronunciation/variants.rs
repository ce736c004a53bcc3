//! Regular variants of pronunciation. Dictionaries of American English list few of them.

/// Returns further pronunciations of the phones, if any: with a flapped T ("metal" as "medal": most
/// of America), and without an R that no vowel follows ("counter" as "counta": most of England).
pub(super) fn variants(phones: &str) -> Vec<String> {
    let phones: Vec<&str> = phones.split(' ').collect();
    [flapped(&phones), without_r(&phones)].into_iter().flatten().collect()
}

fn is_vowel(phone: &str) -> bool {
    phone.starts_with(['A', 'E', 'I', 'O', 'U'])
}

/// Replaces T between vowels by D if the second vowel is unstressed. The dictionary does not mark
/// stress; these vowels are mostly unstressed.
fn flapped(phones: &[&str]) -> Option<String> {
    let mut variant = phones.to_vec();
    for at in 1..phones.len().saturating_sub(1) {
        let unstressed = matches!(phones[at + 1], "AH" | "ER" | "IY");
        if phones[at] == "T" && is_vowel(phones[at - 1]) && unstressed {
            variant[at] = "D";
        }
    }
    (variant != phones).then(|| variant.join(" "))
}

fn without_r(phones: &[&str]) -> Option<String> {
    let before_vowel = |at: usize| phones.get(at + 1).is_some_and(|next| is_vowel(next));
    let mut variant = Vec::with_capacity(phones.len());
    for (at, &phone) in phones.iter().enumerate() {
        match phone {
            _ if before_vowel(at) => variant.push(phone),
            "R" if at > 0 && is_vowel(phones[at - 1]) => {}
            "ER" => variant.push("AH"),
            _ => variant.push(phone),
        }
    }
    (variant != phones).then(|| variant.join(" "))
}

#[cfg(test)]
mod tests {
    use super::variants;

    #[test]
    fn variants_flap_t_and_drop_r() {
        for (phones, expected) in [
            ("M EH T AH L", Some("M EH D AH L")),
            ("M AH T AE L IH K", None),
            ("P L AE S T IH K", None),
            ("K AW N T ER", Some("K AW N T AH")),
            ("M AA R K ER", Some("M AA K AH")),
            ("S M AO L ER R EH D", Some("S M AO L AH R EH D")),
            ("R EH D", None),
            ("V EH R IY", None),
        ] {
            assert_eq!(variants(phones), expected.into_iter().collect::<Vec<_>>(), "{phones}");
        }
    }
}
