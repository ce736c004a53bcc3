//! Other ways in which a word is said, by rules that hold for many speakers of English. Dictionaries
//! of American English list few of them.

/// Further pronunciations of the phones, if any: with a flapped T ("metal" as "medal": most
/// Americans), and without the R that no vowel follows ("counter" as "counta": most of England).
pub(super) fn variants(phones: &str) -> Vec<String> {
    let phones: Vec<&str> = phones.split(' ').collect();
    [flapped(&phones), without_r(&phones)].into_iter().flatten().collect()
}

fn is_vowel(phone: &str) -> bool {
    phone.starts_with(['A', 'E', 'I', 'O', 'U'])
}

/// T between vowels, of which the second has no stress, as D. The dictionary does not mark stress;
/// these vowels mostly have none.
fn flapped(phones: &[&str]) -> Option<String> {
    let mut said = phones.to_vec();
    for at in 1..phones.len().saturating_sub(1) {
        let unstressed = matches!(phones[at + 1], "AH" | "ER" | "IY");
        if phones[at] == "T" && is_vowel(phones[at - 1]) && unstressed {
            said[at] = "D";
        }
    }
    (said != phones).then(|| said.join(" "))
}

fn without_r(phones: &[&str]) -> Option<String> {
    let before_vowel = |at: usize| phones.get(at + 1).is_some_and(|next| is_vowel(next));
    let mut said = Vec::with_capacity(phones.len());
    for (at, &phone) in phones.iter().enumerate() {
        match phone {
            _ if before_vowel(at) => said.push(phone),
            "R" if at > 0 && is_vowel(phones[at - 1]) => {}
            "ER" => said.push("AH"),
            _ => said.push(phone),
        }
    }
    (said != phones).then(|| said.join(" "))
}

#[cfg(test)]
mod tests {
    use super::variants;

    #[test]
    fn t_is_flapped_before_vowels_without_stress() {
        assert_eq!(variants("M EH T AH L"), ["M EH D AH L"]);
        assert_eq!(variants("M AH T AE L IH K"), [""; 0]);
        assert_eq!(variants("P L AE S T IH K"), [""; 0]);
    }

    #[test]
    fn r_is_dropped_where_no_vowel_follows() {
        assert_eq!(variants("K AW N T ER"), ["K AW N T AH"]);
        assert_eq!(variants("M AA R K ER"), ["M AA K AH"]);
        assert_eq!(variants("S M AO L ER R EH D"), ["S M AO L AH R EH D"]);
        assert_eq!(variants("R EH D"), [""; 0]);
        assert_eq!(variants("V EH R IY"), [""; 0]);
    }
}
