//! Leave-one-author-out: each author's lines are read by a judge trained without them, which
//! predicts the performance for new people.

use std::fmt;
use std::sync::Arc;

use crate::model::{Model, Sums};
use crate::scenes::Scenes;
use crate::score::{Score, as_read};
use crate::sources::{Sources, Taught};

/// Number of parts of tables and templates; each is scored by a judge trained on the others.
const FOLDS: usize = 5;

/// How lines were read that were not trained on.
#[derive(Clone, Debug, Default)]
pub struct Unseen {
    /// Score of the judge's statements.
    pub judged: Score,
    /// Score of the readings that the policy receives.
    pub read: Score,
    /// Score of the policy's readings if each line has one slip.
    pub slips: Score,
    /// Sums of both parts of the judge.
    pub sums: Vec<Sums>,
}

impl Unseen {
    /// Adds another one.
    pub fn extend(&mut self, other: Self) {
        self.judged.extend(other.judged);
        self.read.extend(other.read);
        self.slips.extend(other.slips);
        self.sums.extend(other.sums);
    }
}

impl fmt::Display for Unseen {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}  judge", self.judged)?;
        writeln!(f, "{}  as the policy gets it", self.read)?;
        write!(f, "{}  the same with one slip a line", self.slips)
    }
}

/// Returns how an author's lines are read after training without them.
///
/// # Errors
/// A scene that does not exist.
pub fn without_author(scenes: &Scenes, sources: &Sources, author: &str) -> Result<Unseen, String> {
    let model = Model::train(sources, |name, _| name != author);
    score(&scenes.with_judge(&Arc::new(model.judge()?)), &model, sources.all[author].iter())
}

/// Returns how each fifth of a source is read after training without it.
///
/// # Errors
/// A scene that does not exist.
pub fn without_fifths(scenes: &Scenes, sources: &Sources, part: &str) -> Result<Unseen, String> {
    let mut unseen = Unseen::default();
    for fold in 0..FOLDS {
        let model = Model::train(sources, |name, n| name != part || n % FOLDS != fold);
        let left_out = sources.all[part].iter().skip(fold).step_by(FOLDS);
        let scenes = scenes.with_judge(&Arc::new(model.judge()?));
        unseen.extend(score(&scenes, &model, left_out)?);
    }
    Ok(unseen)
}

fn score<'a>(
    scenes: &Scenes,
    model: &Model,
    left_out: impl Iterator<Item = &'a Taught>,
) -> Result<Unseen, String> {
    let mut unseen = Unseen::default();
    for taught in left_out {
        unseen.sums.extend(model.sums(taught));
        for (n, taught) in std::iter::once(taught).chain(&taught.slips).enumerate() {
            let Taught { line, asked, .. } = taught;
            let reader = &scenes.get(&line.scene)?.1;
            let mentions = reader.mentions(&line.text, *asked);
            let read = as_read(&reader.readings(&line.text, &[], *asked), &mentions);
            if n == 0 {
                unseen.judged.add(line, &mentions);
                unseen.read.add(line, &read);
            } else {
                unseen.slips.add(line, &read);
            }
        }
    }
    Ok(unseen)
}
