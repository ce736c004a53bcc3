//! Columns, words and smoothing of a scene, from which the equations are evaluated.

use scene::{AttributeId, Scene, ValueId, WordId};

use super::Model;
use crate::Confusion;

/// Data that the models of one scene share.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tables {
    pub(super) confusion: Confusion,
    pub(super) columns: Vec<Column>,
    pub(super) words: Vec<Word>,
    /// Smoothing of uncertain words.
    pub(super) smoothing: Smoothing,
    /// Smoothing of certain words.
    pub(super) certain: Smoothing,
}

/// Eq. (5) for one `α`.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Smoothing {
    pub(super) alpha: f64,
    pub(super) vocabulary: Vocabulary,
}

/// `ln(|V_D| + α|V|)` per hypothesis: the denominator of eq. (5).
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Vocabulary {
    /// The smallest.
    pub(super) least: f64,
    /// How far each is above the smallest.
    pub(super) above: Vec<f64>,
}

/// One attribute: the value of every hypothesis, and the word of every value.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Column {
    pub(super) values: Vec<u16>,
    /// Probabilities of the values of hypotheses whose value is in doubt, by entry from
    /// [`Model::DOUBTFUL`] on.
    pub(super) doubtful: Vec<Vec<f64>>,
    /// The known value of each of these, if only the user may take it for another.
    pub(super) known: Vec<Option<ValueId>>,
    /// Perception by the user of a hypothesis without the attribute: probability of each value, and
    /// last of its absence. Empty if the user knows, or each has a value.
    pub(super) lacking: Vec<f64>,
    pub(super) words: Vec<WordId>,
    /// Probability that a user takes a value for another one.
    pub(super) misperceived: f64,
    /// Per value: whether some hypotheses have it and others do not.
    pub(super) splits: Vec<bool>,
}

/// Referents of a word, and whether hearing it is informative.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Word {
    pub(super) meanings: Vec<(AttributeId, ValueId)>,
    /// Whether eq. (5) differs between hypotheses.
    pub(super) splits: bool,
}

impl Tables {
    /// Adds a hypothesis that has no words and of which no value is known.
    pub(super) fn add_unknown(&mut self) {
        self.columns.iter_mut().for_each(|column| column.values.push(Model::UNKNOWN));
        let words = self.words.len() as f64;
        for Smoothing { alpha, vocabulary } in [&mut self.smoothing, &mut self.certain] {
            let known = vocabulary.above.iter().map(|log| log + vocabulary.least);
            *vocabulary = Vocabulary::new(known.chain([(*alpha * words).ln()]).collect());
        }
        self.find_what_splits();
    }

    /// Gives the words another `α`, and those that are certain one of their own.
    pub(super) fn smooth(&mut self, objects: usize, alpha: f64, certain: f64) {
        let (lengths, words) = (self.vocabulary_lengths(objects), self.words.len());
        let absent = self.smoothing.vocabulary.above.len() - objects;
        let lengths = || lengths.iter().copied().chain(std::iter::repeat_n(0, absent));
        self.smoothing = Smoothing::new(alpha, lengths(), words);
        self.certain = Smoothing::new(certain, lengths(), words);
    }

    /// The highest rate of misperception of an attribute.
    pub(super) fn misperceived(&self) -> f64 {
        self.columns.iter().map(|column| column.misperceived).fold(0.0, f64::max)
    }

    /// `|V_D|` of every object.
    pub(super) fn vocabulary_lengths(&self, objects: usize) -> Vec<usize> {
        // A value in doubt is one of the object's words, whichever it is.
        let in_doubt = |i: usize| -> usize {
            let doubtful =
                |column: &&Column| (Model::DOUBTFUL..Model::UNKNOWN).contains(&column.values[i]);
            self.columns.iter().filter(doubtful).count()
        };
        let has = |i: usize, word: &&Word| {
            word.meanings.iter().any(|(k, v)| self.columns[k.index()].values[i] == v.0)
        };
        let certain = |i: usize| self.words.iter().filter(|word| has(i, word)).count();
        (0..objects).map(|i| certain(i) + in_doubt(i)).collect()
    }

    /// Notes which words and values distinguish hypotheses.
    pub(super) fn find_what_splits(&mut self) {
        for column in &mut self.columns {
            let unsure = column.values.len() > 1
                && (!column.doubtful.is_empty() || column.values.contains(&Model::UNKNOWN));
            let mut count = vec![0; column.words.len()];
            for &value in column.values.iter().filter(|value| **value < Model::DOUBTFUL) {
                count[usize::from(value)] += 1;
            }
            let some = |n: usize| n > 0 && n < column.values.len();
            column.splits = count.into_iter().map(|n| unsure || some(n)).collect();
        }
        let above = &self.smoothing.vocabulary.above;
        let hypotheses = above.len();
        let vocabulary = above.iter().any(|above| *above > 0.0);
        for word in &mut self.words {
            let has = |i: usize| {
                (word.meanings.iter()).any(|(k, v)| self.columns[k.index()].values[i] == v.0)
            };
            let doubtful =
                |(k, _): &(AttributeId, ValueId)| !self.columns[k.index()].doubtful.is_empty();
            word.splits = vocabulary
                || word.meanings.iter().any(doubtful)
                || (1..hypotheses).any(|i| has(i) != has(0));
        }
    }
}

impl Column {
    /// Lets a user take each value for another one with that probability, any other alike, and give
    /// any value to objects for which the scene has none.
    pub(super) fn misperceive(&mut self, rate: f64) {
        let values = self.words.len();
        if values < 2 || rate <= 0.0 {
            return;
        }
        self.misperceived = rate;
        if self.values.contains(&Model::LACKS) {
            self.lacking = vec![rate / values as f64; values];
            self.lacking.push(1.0 - rate);
        }
        let other = rate / (values - 1) as f64;
        let blur = |chance: f64| chance * (1.0 - rate) + (1.0 - chance) * other;
        for chances in &mut self.doubtful {
            chances.iter_mut().for_each(|chance| *chance = blur(*chance));
        }
        let mut place = vec![None; values];
        for entry in self.values.iter_mut().filter(|entry| **entry < Model::DOUBTFUL) {
            let v = usize::from(*entry);
            let (doubtful, known) = (&mut self.doubtful, &mut self.known);
            *entry = *place[v].get_or_insert_with(|| {
                let is_own = |m: usize| f64::from(u8::from(m == v));
                doubtful.push((0..values).map(|m| blur(is_own(m))).collect());
                known.push(Some(ValueId::from(v)));
                Model::DOUBTFUL + (doubtful.len() - 1) as u16
            });
        }
    }
}

impl Smoothing {
    /// `lengths` are `|V_D|` of the objects, `words` is `|V|`.
    pub(super) fn new(alpha: f64, lengths: impl Iterator<Item = usize>, words: usize) -> Self {
        let smoothing = alpha * words as f64;
        let log = lengths.map(|length| (length as f64 + smoothing).ln());
        Self { alpha, vocabulary: Vocabulary::new(log.collect()) }
    }
}

impl Vocabulary {
    pub(super) fn new(log: Vec<f64>) -> Self {
        let least = log.iter().copied().fold(f64::INFINITY, f64::min);
        Self { least, above: log.iter().map(|log| log - least).collect() }
    }
}

impl Column {
    pub(super) fn of(scene: &Scene, k: AttributeId) -> Self {
        let mut doubtful: Vec<Vec<f64>> = Vec::new();
        let mut entry = |object: &scene::Object| match object.chances.get(k.index()) {
            Some(Some(chances)) => {
                let known = doubtful.iter().position(|known| known == chances);
                let place = known.unwrap_or_else(|| {
                    doubtful.push(chances.clone());
                    doubtful.len() - 1
                });
                Model::DOUBTFUL + place as u16
            }
            _ => object.values[k.index()].map_or(Model::LACKS, |v| v.0),
        };
        let values = scene.objects().iter().map(&mut entry).collect();
        let words = scene.attributes()[k.index()].values.iter().map(|value| value.word).collect();
        let known = vec![None; doubtful.len()];
        let lacking = Vec::new();
        Self { values, doubtful, known, lacking, words, misperceived: 0.0, splits: Vec::new() }
    }
}
