//! Score of the reader's statements about each value word.

use std::fmt;

use language::{Mention, Polarity};
use scene::{Intent, Reading, Reference, WordId};

use crate::line::{Line, Marked};

/// Least probability of a certain statement.
const CERTAIN: f64 = 0.9;
/// Least probability at which a polarity counts as stated.
const STATED: f64 = 0.95;
/// Bins of the calibration error.
const BINS: usize = 15;

/// A value word that the reader has found, its label, and the reader's statement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scored {
    /// The label.
    pub truth: Polarity,
    /// Probabilities of wanted, denied, neither.
    pub stated: [f64; 3],
}

impl Scored {
    fn best(&self) -> (Polarity, f64) {
        let all = [Polarity::Wanted, Polarity::Denied, Polarity::Neither];
        let best = all.into_iter().zip(self.stated).max_by(|a, b| a.1.total_cmp(&b.1));
        best.expect("three polarities")
    }
}

/// Counts over lines.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Score {
    /// Value words that the reader has found and the author has labelled.
    pub scored: Vec<Scored>,
    /// Value words that the reader has not found.
    pub missed: usize,
    /// Words that the reader takes for values and the author does not.
    pub extra: usize,
}

impl Score {
    /// Adds the reader's statements about a line.
    pub fn add(&mut self, line: &Line, mentions: &[Mention]) {
        let labels = labels(line, mentions.iter().map(|mention| &*mention.surface));
        self.extra += labels.iter().filter(|label| label.is_none()).count();
        let found = labels.iter().flatten().count();
        self.missed += line.marked.len() - found;
        for (mention, truth) in mentions.iter().zip(&labels) {
            let stated = [mention.wanted, mention.denied, mention.neither];
            self.scored.extend(truth.map(|truth| Scored { truth, stated }));
        }
    }

    /// Adds another score.
    pub fn extend(&mut self, other: Self) {
        self.scored.extend(other.scored);
        self.missed += other.missed;
        self.extra += other.extra;
    }

    fn share(&self, holds: impl Fn(&Scored) -> bool) -> f64 {
        self.scored.iter().filter(|it| holds(it)).count() as f64 / self.scored.len().max(1) as f64
    }

    /// Returns the share of right statements.
    pub fn right(&self) -> f64 {
        self.share(|it| it.best().0 == it.truth)
    }

    /// Returns the share of certain and wrong statements.
    pub fn certain_and_wrong(&self) -> f64 {
        self.share(|it| it.best().0 != it.truth && it.best().1 >= CERTAIN)
    }

    /// Denied values that are certainly wanted, and denied values.
    pub fn denied_but_wanted(&self) -> (usize, usize) {
        let denied = || self.scored.iter().filter(|it| it.truth == Polarity::Denied);
        (denied().filter(|it| it.stated[0] >= CERTAIN).count(), denied().count())
    }

    /// Share of the statements of at least 0.95 that are true.
    pub fn stated_and_true(&self) -> f64 {
        let stated: Vec<_> = self.scored.iter().filter(|it| it.best().1 >= STATED).collect();
        let right = stated.iter().filter(|it| it.best().0 == it.truth).count();
        right as f64 / stated.len().max(1) as f64
    }

    /// Expected calibration error of the most probable polarity.
    pub fn calibration_error(&self) -> f64 {
        let mut bins = [(0.0, 0.0); BINS];
        for (truth, (best, stated)) in self.scored.iter().map(|it| (it.truth, it.best())) {
            let bin = &mut bins[((stated * BINS as f64) as usize).min(BINS - 1)];
            bin.0 += stated;
            bin.1 += f64::from(u8::from(best == truth));
        }
        let off: f64 = bins.iter().map(|(stated, right)| (stated - right).abs()).sum();
        off / self.scored.len().max(1) as f64
    }

    /// Share that is stated with less than 0.9.
    pub fn unsure(&self) -> f64 {
        self.share(|it| it.best().1 < CERTAIN)
    }

    /// Mean negative logarithm of the probability of the label.
    pub fn log_loss(&self) -> f64 {
        let loss = |it: &Scored| -it.stated[it.truth as usize].max(1e-9).ln();
        self.scored.iter().map(loss).sum::<f64>() / self.scored.len().max(1) as f64
    }
}

impl fmt::Display for Score {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (wanted, denied) = self.denied_but_wanted();
        write!(
            f,
            "{:5} mentions  right {:.3}  certain and wrong {:.3}  denied but wanted {wanted}/{denied}  stated and true {:.3}  \
             ECE {:.3}  unsure {:.3}  log loss {:.3}  missed {}  extra {}",
            self.scored.len(),
            self.right(),
            self.certain_and_wrong(),
            self.stated_and_true(),
            self.calibration_error(),
            self.unsure(),
            self.log_loss(),
            self.missed,
            self.extra,
        )
    }
}

/// The label of each value word that the reader has found, by the words found; `None` if the author
/// has marked nothing there.
pub fn labels<'a>(
    line: &Line,
    surfaces: impl IntoIterator<Item = &'a str>,
) -> Vec<Option<Polarity>> {
    let mut left = line.marked.iter();
    let label = |surface: &str| {
        let mut ahead = left.clone();
        let found = ahead.find(|marked| is_same(marked, surface))?;
        left = ahead;
        Some(found.polarity)
    };
    surfaces.into_iter().map(label).collect()
}

fn is_same(marked: &Marked, surface: &str) -> bool {
    let plain = |text: &str| -> String {
        text.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect()
    };
    let (marked, surface) = (plain(&marked.surface), plain(surface));
    marked.contains(&surface) || surface.contains(&marked)
}

/// Polarities of an utterance's value words by its weighted readings, as the policy uses them:
/// those of further objects are wanted too, and a question is not a wish.
pub fn as_read(readings: &[(f64, Reading)], mentions: &[Mention]) -> Vec<Mention> {
    let weight = |holds: &dyn Fn(&Reading) -> bool| -> f64 {
        let is_wish = |reading: &Reading| match reading.intent {
            Intent::Inform | Intent::Stop | Intent::GoOn => true,
            Intent::Cancel => !reading.excluded.is_empty(),
            _ => false,
        };
        let wishes = readings.iter().filter(|(_, reading)| is_wish(reading));
        wishes.filter(|(_, reading)| holds(reading)).map(|(weight, _)| weight).sum()
    };
    let has = |groups: &[Vec<WordId>], word| groups.iter().any(|group| group.contains(&word));
    let as_read = |mention: &Mention| {
        let is_wanted = |reading: &Reading| {
            let is_further = !matches!(reading.refers, Reference::Relation(_))
                && has(&reading.further, mention.word);
            reading.base.contains(&mention.word) || is_further
        };
        let wanted = weight(&is_wanted);
        let denied = weight(&|reading| has(&reading.excluded, mention.word) && !is_wanted(reading));
        Mention { wanted, denied, neither: (1.0 - wanted - denied).max(0.0), ..mention.clone() }
    };
    mentions.iter().map(as_read).collect()
}
