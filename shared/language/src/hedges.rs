//! How sure a person is who says "I think so" or "probably".
//!
//! | words | sure | from |
//! |---|---|---|
//! | `almost`, `nearly`, `pretty`, `fairly`, `quite`, `very`, `highly`, `most`, `certain` | 0.9 | half the way from `likely` to certain, as "very" is: Mosteller and Youtz 1990 |
//! | `think`, `believe`, `say`, `imagine`, `expect`, what is remembered or looks so | 0.8 | judged: people say it of what they want or saw |
//! | `probably`, `likely`, `should`, `must`, `supposedly` | 0.75 | about 0.7 in Mosteller and Youtz 1990, of events; judged a little higher of one's own things |
//! | `guess`, `suppose`, `reckon`, `assume`, `sort of` | 0.7 | judged |
//! | `maybe`, `perhaps`, `possibly`, `might`, `could` | 0.6 | judged: "possible" means something else to everybody, and people say it to be polite |
//! | any other way of not knowing | 0.55 | judged: it says little, not nothing |
//!
//! "Sure" is how often what is said with these words holds. A scene word is doubted by `1 − sure`;
//! an answer or a denial by `2 (1 − sure)`, because half of an answer that was not given is right
//! by chance ([`scene::Doubt`]).
//!
//! F. Mosteller and C. Youtz, "Quantifying probabilistic expressions", Statistical Science 5(1),
//! 1990.

use crate::clauses::{Clause, Topic};
use crate::cue::{Cue, cues};
use crate::lexicon::Sense;
use crate::marks::Mark;
use crate::tokens::Gap;

/// Words and how sure who uses them is; the first row that has a word of a phrase counts.
const SURENESS: &[(f64, &[&str])] = &[
    (0.9, &["almost", "nearly", "pretty", "fairly", "quite", "very", "highly", "most", "certain"]),
    (
        0.8,
        &[
            "think", "believe", "say", "imagine", "expect", "suspect", "bet", "seems", "seem",
            "looks", "feels", "sounds", "smells", "appears", "memory", "recall", "remember",
            "checked", "looked", "saw", "heard", "mistaken", "positive", "doubt", "doubtful",
            "unlikely", "hardly",
        ],
    ),
    (
        0.75,
        &[
            "probably",
            "probability",
            "likely",
            "likelihood",
            "should",
            "must",
            "ought",
            "presumably",
            "apparently",
            "supposedly",
            "inclined",
            "leaning",
            "chances",
            "odds",
        ],
    ),
    (
        0.7,
        &[
            "guess",
            "guessing",
            "suppose",
            "reckon",
            "assume",
            "presume",
            "gather",
            "fancy",
            "kind",
            "sort",
            "kinda",
            "sorta",
            "more",
            "basically",
            "mostly",
            "know",
            "knowledge",
        ],
    ),
    (
        0.6,
        &[
            "maybe",
            "perhaps",
            "possibly",
            "might",
            "may",
            "could",
            "conceivably",
            "perchance",
            "potentially",
            "feasibly",
            "plausibly",
        ],
    ),
];
/// Of a phrase without any of these words.
const SURE_LEAST: f64 = 0.55;
/// "maybe" as an answer.
pub(crate) const MAYBE: f64 = 0.6;

/// How sure somebody is who says this phrase, 1 for a phrase that hedges nothing.
pub(crate) fn sureness(cue: Cue, phrase: &str) -> f64 {
    let of = |rows: &[(f64, &[&str])]| {
        let said = |words: &[&str]| phrase.split(' ').any(|word| words.contains(&word));
        rows.iter().find(|(_, words)| said(words)).map(|(sure, _)| *sure)
    };
    match cue {
        Cue::Hedge | Cue::Likely | Cue::Unsure => of(SURENESS).unwrap_or(SURE_LEAST),
        // "I think so", "I doubt it", but not "good guess" and "no doubt"
        Cue::Yes if phrase.ends_with(" so") => of(SURENESS).unwrap_or(1.0),
        Cue::No if phrase.contains("doubt") || phrase.ends_with("likely") => {
            of(SURENESS).unwrap_or(1.0)
        }
        Cue::No if phrase.ends_with(" so") || phrase.contains("not that i") => {
            of(SURENESS).unwrap_or(1.0)
        }
        _ => 1.0,
    }
}

/// "I don't think", where "think" is no phrase of its own.
fn sureness_of(mark: &Mark<'_>) -> f64 {
    match mark.sense {
        Sense::Cue(Cue::Hedge | Cue::Likely | Cue::Unsure) => mark.sure,
        Sense::Cue(Cue::Plain) if matches!(mark.word, "think" | "believe") => {
            sureness(Cue::Hedge, mark.word)
        }
        _ => 1.0,
    }
}

/// Lets each hedge weaken what is said in its clause; one that stands alone, what was said before
/// it in the same sentence, or else what follows: "the white one, I think".
pub(crate) fn hedge(marks: &mut [Mark<'_>], clauses: &[Clause]) {
    for (n, clause) in clauses.iter().enumerate().filter(|(_, clause)| clause.topic == Topic::On) {
        let sure = marks[clause.marks.clone()].iter().map(sureness_of).fold(1.0, f64::min);
        if sure == 1.0 {
            continue;
        }
        let goes_on = |clause: &Clause| marks[clause.marks.start].gap < Gap::Stop;
        let beside = match says_more(&marks[clause.marks.clone()]) {
            true => None,
            false => n
                .checked_sub(1)
                .filter(|_| goes_on(clause))
                .or((n + 1 < clauses.len() && goes_on(&clauses[n + 1])).then_some(n + 1)),
        };
        let beside = beside.map_or(0..0, |n| clauses[n].marks.clone());
        for at in clause.marks.clone().chain(beside) {
            marks[at].sure = marks[at].sure.min(sure);
        }
    }
}

/// Whether a clause says anything that a hedge in it weakens.
fn says_more(clause: &[Mark<'_>]) -> bool {
    clause.iter().any(|mark| {
        mark.value().is_some() || mark.is_any(cues![Yes No WeakYes WeakNo Not Except Other])
    })
}

#[cfg(test)]
mod tests {
    use super::{Cue, sureness};

    #[test]
    fn the_surer_the_words_the_less_the_doubt() {
        let order = [
            (Cue::Likely, "most likely"),
            (Cue::Yes, "i think so"),
            (Cue::Likely, "probably"),
            (Cue::Yes, "i guess so"),
            (Cue::Hedge, "maybe"),
            (Cue::Unsure, "no idea"),
        ];
        let sure: Vec<f64> = order.iter().map(|(cue, phrase)| sureness(*cue, phrase)).collect();
        assert!(sure.windows(2).all(|pair| pair[0] > pair[1]), "{sure:?}");
        assert!(sure.iter().all(|sure| (0.5..1.0).contains(sure)));
    }

    #[test]
    fn a_plain_answer_is_sure() {
        for (cue, phrase) in [
            (Cue::Yes, "yes"),
            (Cue::Yes, "no doubt"),
            (Cue::Yes, "good guess"),
            (Cue::No, "guess again"),
            (Cue::WeakYes, "you could say that"),
        ] {
            assert_eq!(sureness(cue, phrase), 1.0, "{phrase}");
        }
    }
}
