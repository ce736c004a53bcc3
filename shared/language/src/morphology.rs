//! The forms in which a value's words turn up: plurals, comparatives, compounds written apart.

/// Inflected forms of a word: plural, and for a quality its comparative, superlative and "-ish".
/// Ungrammatical forms are harmless, because people do not say them.
pub(crate) fn inflected(word: &str, quality: bool) -> Vec<String> {
    let Some(last) = word.chars().last().filter(char::is_ascii_alphabetic) else {
        return Vec::new();
    };
    if word.len() < 2 {
        return Vec::new();
    }
    let mut forms = plurals(word, last);
    if quality {
        let stem = quality_stem(word, last);
        forms.extend(["er", "est", "ish"].map(|ending| format!("{stem}{ending}")));
    }
    forms
}

/// The comparative and the superlative of a quality.
pub(crate) fn comparatives(word: &str) -> Option<[String; 2]> {
    let stem = quality_stem(word, word.chars().last().filter(char::is_ascii_alphabetic)?);
    Some(["er", "est"].map(|ending| format!("{stem}{ending}")))
}

/// The singulars that a word may be the plural of, the likelier first: "nut" of "nuts", "berry" of
/// "berries", "box" of "boxes", "rose" of "roses".
pub(crate) fn singulars(word: &str) -> Vec<String> {
    const LETTERS_MIN: usize = 4;
    let Some(stem) = word.strip_suffix('s') else { return Vec::new() };
    let mut forms = Vec::new();
    if let Some(stem) = word.strip_suffix("ies").filter(|stem| stem.len() > 1) {
        forms.push(format!("{stem}y"));
    }
    let hisses = |stem: &&str| ["ch", "sh", "s", "x", "z"].iter().any(|end| stem.ends_with(end));
    forms.extend(word.strip_suffix("es").filter(hisses).map(str::to_owned));
    if word.len() >= LETTERS_MIN && !stem.ends_with(['s', 'u', 'i']) {
        forms.push(stem.to_owned());
    }
    forms
}

fn plurals(word: &str, last: char) -> Vec<String> {
    let stem = &word[..word.len() - 1];
    let hisses = word.ends_with("ch") || word.ends_with("sh") || matches!(last, 's' | 'x' | 'z');
    let mut forms = match last {
        'y' if !stem.ends_with(is_vowel) => vec![format!("{stem}ies")],
        'f' if !stem.ends_with('f') => vec![format!("{stem}ves"), format!("{word}s")],
        'o' => vec![format!("{word}s"), format!("{word}es")],
        _ if hisses => vec![format!("{word}es")],
        _ => vec![format!("{word}s")],
    };
    if let Some(stem) = word.strip_suffix("fe") {
        forms.push(format!("{stem}ves"));
    }
    forms
}

/// "big" to "bigg-", "white" to "whit-", "shiny" to "shini-".
fn quality_stem(word: &str, last: char) -> String {
    let stem = &word[..word.len() - 1];
    let mut before = stem.chars().rev();
    let (vowel, onset) = (before.next(), before.next());
    match last {
        'e' => stem.to_owned(),
        'y' => format!("{stem}i"),
        c if !is_vowel(c)
            && !matches!(c, 'w' | 'x')
            && vowel.is_some_and(is_vowel)
            && !onset.is_some_and(is_vowel)
            && word.len() <= 4 =>
        {
            format!("{word}{c}")
        }
        _ => word.to_owned(),
    }
}

fn is_vowel(c: char) -> bool {
    matches!(c, 'a' | 'e' | 'i' | 'o' | 'u')
}

#[cfg(test)]
mod tests {
    use super::{inflected, singulars};

    #[test]
    fn morphology_forms_are_english() {
        for (word, forms) in [
            ("big", "bigs bigger biggest biggish"),
            ("white", "whites whiter whitest whitish"),
            ("shiny", "shinies shinier shiniest shiniish"),
            ("clear", "clears clearer clearest clearish"),
            ("round", "rounds rounder roundest roundish"),
            ("red", "reds redder reddest reddish"),
        ] {
            assert_eq!(inflected(word, true).join(" "), forms);
        }
        for (word, forms) in [
            ("shelf", "shelves shelfs"),
            ("wrench", "wrenches"),
            ("knife", "knifes knives"),
            ("tray", "trays"),
            ("berry", "berries"),
            ("potato", "potatos potatoes"),
            ("7", ""),
            ("é", ""),
        ] {
            assert_eq!(inflected(word, false).join(" "), forms);
        }
    }

    #[test]
    fn singulars_are_those_of_plurals() {
        for (word, forms) in [
            ("nuts", "nut"),
            ("berries", "berry berrie"),
            ("cookies", "cooky cookie"),
            ("boxes", "box boxe"),
            ("roses", "ros rose"),
            ("sizes", "siz size"),
            ("glasses", "glass glasse"),
            ("spices", "spice"),
            ("glass", ""),
            ("gas", ""),
            ("cactus", ""),
            ("red", ""),
        ] {
            assert_eq!(singulars(word).join(" "), forms, "{word}");
        }
    }
}
