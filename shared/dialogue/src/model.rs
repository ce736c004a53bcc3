//! The observation model's tables for one scene.

use std::sync::Arc;

use scene::{AttributeId, ObjectId, Options, Question, Scene, ValueId, WordId};

use crate::Confusion;
use tables::{Column, Smoothing, Tables, Word};
use vocabulary::{Params, Reliability};

mod misperception;
mod tables;
mod words;

/// Smoothing of words that are certain. Their values are doubted by the rates of misperception, and once
/// is enough; above 0, so that words that contradict one another leave a belief.
pub const CERTAIN_SMOOTHING: f64 = 1e-6;

/// Data of a scene for equations (4)–(7), attribute by attribute.
///
/// Values lie column-wise (one small integer per object and attribute), so that the likelihood of
/// a word or an answer is one pass over one column, for thousands of objects alike.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    params: Params,
    objects: usize,
    absent: bool,
    /// The model of a user who never mistakes values, if this user may.
    plain: Option<Box<Self>>,
    /// Whether values in doubt have been updated with an interaction's utterances.
    is_of_interaction: bool,
    /// Shared by the models of one scene: only parameters differ from person to person.
    tables: Arc<Tables>,
}

impl Model {
    /// Stands in a column for an object that lacks the attribute.
    pub const LACKS: u16 = u16::MAX;
    /// Value in every column for the absent object: its values are unknown.
    pub const UNKNOWN: u16 = u16::MAX - 1;
    /// Entries of a column from this one up to [`Model::UNKNOWN`] denote values in doubt
    /// ([`Model::chances`]): equal entries for equal doubts.
    pub const DOUBTFUL: u16 = 1 << 15;

    /// The tables of a scene.
    ///
    /// # Panics
    /// If the parameters are out of range: [`Params::check`] says which.
    pub fn new(scene: &Scene, params: Params) -> Self {
        assert!(params.check().is_empty(), "parameters out of range: {params:?}");
        let columns: Vec<Column> = (0..scene.attributes().len())
            .map(|k| Column::of(scene, AttributeId::from(k)))
            .collect();
        let mut words = vec![Word::default(); scene.words().len()];
        for (k, column) in columns.iter().enumerate() {
            for (v, word) in column.words.iter().enumerate() {
                words[word.index()].meanings.push((AttributeId::from(k), ValueId::from(v)));
            }
        }
        let objects = scene.objects().len();
        let lengths = (0..objects).map(|i| scene.vocabulary_len(ObjectId::from(i)));
        let smoothing = Smoothing::new(params.alpha, lengths, words.len());
        let confusion = Confusion::even(words.len());
        let certain = smoothing.clone();
        let mut tables = Tables { confusion, columns, words, smoothing, certain };
        tables.find_what_splits();
        let tables = Arc::new(tables);
        Self { params, objects, absent: false, plain: None, is_of_interaction: false, tables }
    }

    /// The same model of a scene with other objects and the same words, except for those of the
    /// places that distinguish like objects: they come last.
    #[must_use]
    pub fn with_objects(&self, scene: &Scene) -> Self {
        let same = Self::new(scene, self.params).with_certain_words(self.tables.certain.alpha);
        let mut rates: Vec<f64> =
            self.tables.columns.iter().map(|column| column.misperceived).collect();
        rates.resize(scene.attributes().len(), 0.0);
        let confusion = self.tables.confusion.clone().resized(scene.words().len());
        same.with_misperceptions(&rates).with_confusion(confusion)
    }

    /// The model with another smoothing for words that are certain
    /// ([`CERTAIN_DOUBT`](crate::CERTAIN_DOUBT)). By default they have `α`, as in the paper.
    ///
    /// # Panics
    /// If `alpha` is not above 0, or the model already has a hypothesis beyond the objects.
    #[must_use]
    pub fn with_certain_words(mut self, alpha: f64) -> Self {
        assert!(alpha > 0.0 && alpha.is_finite(), "{alpha} is not a smoothing weight");
        assert!(!self.absent, "the objects' words come first");
        let tables = Arc::make_mut(&mut self.tables);
        let lengths = tables.vocabulary_lengths(self.objects);
        tables.certain = Smoothing::new(alpha, lengths.into_iter(), tables.words.len());
        self
    }

    /// The model with one hypothesis more, after the objects: that the wanted object is not here.
    ///
    /// It has no words of the scene, so that eq. (5) makes it speak every word with `1/|V|`. Its
    /// properties are unknown: "is its k v?" is answered with yes as often as one of `|V_k|` values
    /// or something else would be, and an open question with any value. Pointing is answered with
    /// no.
    #[must_use]
    pub fn with_absent(mut self) -> Self {
        if !self.absent {
            self.absent = true;
            self.plain = self.plain.map(|plain| Box::new(plain.with_absent()));
            Arc::make_mut(&mut self.tables).add_unknown();
        }
        self
    }

    /// Returns the model with the given confusions between words.
    ///
    /// # Panics
    /// If it is not about as many words as the scene has.
    #[must_use]
    pub fn with_confusion(mut self, confusion: Confusion) -> Self {
        assert_eq!(confusion.words(), self.tables.words.len(), "about the scene's words");
        let plain = self.plain.take();
        self.plain = plain.map(|plain| Box::new(plain.with_confusion(confusion.clone())));
        Arc::make_mut(&mut self.tables).confusion = confusion;
        self
    }

    /// The same scene with other parameters.
    ///
    /// # Panics
    /// If the parameters are out of range, or `α` is not the same: the words' tables are built for
    /// it.
    #[must_use]
    pub fn with_params(&self, params: Params) -> Self {
        assert!(params.check().is_empty(), "parameters out of range: {params:?}");
        assert_eq!(params.alpha, self.params.alpha, "α is not a person's");
        let plain = self.plain.as_ref().map(|plain| Box::new(plain.with_params(params)));
        Self { params, plain, ..self.clone() }
    }

    /// `p_l`, `ε` and `α`.
    pub fn params(&self) -> Params {
        self.params
    }

    /// `|I|`: how many objects there are.
    pub fn objects(&self) -> usize {
        self.objects
    }

    /// The hypothesis that the wanted object is not here, if the model has it: one past the last
    /// object.
    pub fn absent(&self) -> Option<ObjectId> {
        self.absent.then(|| ObjectId::from(self.objects))
    }

    /// Length of a belief: the objects, and one more if the wanted one may be absent.
    pub fn hypotheses(&self) -> usize {
        self.objects + usize::from(self.absent)
    }

    /// `|K|`: how many attributes there are.
    pub fn attributes(&self) -> usize {
        self.tables.columns.len()
    }

    /// `|V_k|`: how many values the attribute can have, whether or not an object has them.
    pub fn values(&self, k: AttributeId) -> usize {
        self.tables.columns[k.index()].words.len()
    }

    /// The value index of every hypothesis for attribute `k`, or [`Model::LACKS`], or
    /// [`Model::UNKNOWN`].
    pub fn column(&self, k: AttributeId) -> &[u16] {
        &self.tables.columns[k.index()].values
    }

    /// The word that value `v` of attribute `k` is.
    pub fn word(&self, k: AttributeId, v: ValueId) -> WordId {
        self.tables.columns[k.index()].words[v.index()]
    }

    /// The attributes and values that a word denotes: one, or more if attributes share it.
    pub fn meanings(&self, word: WordId) -> &[(AttributeId, ValueId)] {
        &self.tables.words[word.index()].meanings
    }

    /// Whether "is its k v?" can be answered differently about different hypotheses.
    pub(crate) fn splits(&self, k: AttributeId, v: ValueId) -> bool {
        self.tables.columns[k.index()].splits[v.index()]
    }

    /// Probability that "is its k v?" is answered with yes about something unknown, given an
    /// answer: it is one of the `|V_k|` values or something else, each as likely.
    pub(crate) fn unknown_yes(&self, k: AttributeId) -> f64 {
        1.0 / (self.values(k) as f64 + 1.0)
    }

    /// The value of object `i` for attribute `k`, if it has one; the likeliest of those in doubt.
    /// The user's perception of it plays no part.
    pub fn value(&self, i: ObjectId, k: AttributeId) -> Option<ValueId> {
        let entry = self.column(k)[i.index()];
        if let known @ Some(_) = self.known(k, entry) {
            return known;
        }
        match self.chances(k, entry) {
            None => (entry < Self::DOUBTFUL).then_some(ValueId(entry)),
            Some(chances) => {
                let likelier = |best, v| if chances[v] > chances[best] { v } else { best };
                (0..chances.len()).reduce(likelier).map(ValueId::from)
            }
        }
    }

    /// `attr_k,v(i)`: false for an object that lacks the attribute, and for the absent object. Of
    /// values in doubt, it is true of the likeliest.
    pub fn has(&self, i: ObjectId, k: AttributeId, v: ValueId) -> bool {
        let entry = self.column(k)[i.index()];
        entry == v.0 || entry >= Self::DOUBTFUL && self.value(i, k) == Some(v)
    }

    /// Probability of each value of attribute `k`, if that entry of its column denotes a doubt.
    pub fn chances(&self, k: AttributeId, entry: u16) -> Option<&[f64]> {
        let doubt = entry.checked_sub(Self::DOUBTFUL).filter(|_| entry < Self::UNKNOWN)?;
        self.tables.columns[k.index()].doubtful.get(usize::from(doubt)).map(Vec::as_slice)
    }

    /// Whether any object's value of attribute `k` is in doubt.
    pub fn is_doubtful(&self, k: AttributeId) -> bool {
        !self.tables.columns[k.index()].doubtful.is_empty()
    }

    /// Probabilities of the values of attribute `k`, for every doubt about it.
    pub(crate) fn all_chances(&self, k: AttributeId) -> &[Vec<f64>] {
        &self.tables.columns[k.index()].doubtful
    }

    /// `α` of words, which may be another for those that are certain.
    pub(crate) fn smoothing(&self, is_certain: bool) -> f64 {
        if is_certain { self.tables.certain.alpha } else { self.tables.smoothing.alpha }
    }

    /// Perception by the user of an object without attribute `k`: probability of each value, and
    /// last of its absence. Empty if the user knows, or each has a value.
    pub(crate) fn lacking(&self, k: AttributeId) -> &[f64] {
        &self.tables.columns[k.index()].lacking
    }

    /// Multiplies probabilities of values in doubt by likelihoods; the missing value comes last.
    pub(crate) fn weigh_doubts(&mut self, k: AttributeId, likelihood: &[f64]) {
        self.is_of_interaction = true;
        let column = &mut Arc::make_mut(&mut self.tables).columns[k.index()];
        let lacking = Some(&mut column.lacking).filter(|it| !it.is_empty());
        for chances in column.doubtful.iter_mut().chain(lacking) {
            chances.iter_mut().zip(likelihood).for_each(|(chance, p)| *chance *= p);
            let sum: f64 = chances.iter().sum();
            chances.iter_mut().for_each(|chance| *chance /= sum);
        }
    }

    /// Probability of `attr_k,v(i)`.
    pub(crate) fn chance(&self, i: ObjectId, k: AttributeId, v: ValueId) -> f64 {
        let entry = self.column(k)[i.index()];
        self.chances(k, entry).map_or(f64::from(u8::from(entry == v.0)), |it| it[v.index()])
    }

    /// Probability of `1_{V_D}(w)` with `D = i`: at least one of the values that are the word.
    pub(crate) fn word_chance(&self, i: ObjectId, word: WordId) -> f64 {
        let lacking = self.meanings(word).iter().map(|&(k, v)| 1.0 - self.chance(i, k, v));
        1.0 - lacking.product::<f64>()
    }

    /// Whether one of the values that are the word is in doubt of some object.
    fn is_doubtful_word(&self, word: WordId) -> bool {
        self.meanings(word).iter().any(|(k, _)| self.is_doubtful(*k))
    }

    /// `1_{V_D}(w)` with `D = i`.
    pub fn has_word(&self, i: ObjectId, word: WordId) -> bool {
        self.meanings(word).iter().any(|&(k, v)| self.has(i, k, v))
    }

    /// Whether every hypothesis certainly has one of these values.
    pub(crate) fn all_have(&self, k: AttributeId, options: Options) -> bool {
        self.column(k).iter().all(|entry| match self.chances(k, *entry) {
            Some(chances) => {
                let is_possible = |v: &usize| chances[*v] > 0.0;
                let mut possible = (0..chances.len()).filter(is_possible);
                possible.all(|v| options.contains(ValueId::from(v)))
            }
            None => options.contains(ValueId(*entry)),
        })
    }

    /// Whether the question is about an object, attribute and value of this scene.
    pub fn contains(&self, question: Question) -> bool {
        match question {
            Question::None => true,
            Question::Point(i) => i.index() < self.objects,
            Question::Which(k) => k.index() < self.tables.columns.len(),
            Question::Attribute(k, v) => {
                k.index() < self.tables.columns.len() && v.index() < self.values(k)
            }
            Question::Choice(k, options) => {
                let is_value = |v: &ValueId| v.index() < self.values(k);
                k.index() < self.tables.columns.len() && options.values().iter().all(is_value)
            }
        }
    }

    /// Tells everything that answers depend on, as numbers.
    pub(crate) fn identify(&self, tell: &mut dyn FnMut(u64)) {
        let Params { p_l, epsilon, alpha, open, choice } = self.params;
        [p_l, epsilon, alpha].into_iter().for_each(|parameter| tell(parameter.to_bits()));
        for (kind, own) in (1..).zip([open, choice]) {
            if let Some(Reliability { p_l, epsilon }) = own {
                [kind, p_l.to_bits(), epsilon.to_bits()].into_iter().for_each(&mut *tell);
            }
        }
        tell(self.hypotheses() as u64);
        for column in &self.tables.columns {
            tell(column.words.len() as u64);
            column.doubtful.iter().flatten().for_each(|chance| tell(chance.to_bits()));
            column.values.iter().for_each(|value| tell(u64::from(*value)));
            column.words.iter().for_each(|word| tell(word.index() as u64));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{bowls, scene};

    #[test]
    fn tables_agree_with_the_scene() {
        let scene = bowls();
        let model = Model::new(&scene, Params::default());
        assert_eq!((model.objects(), model.attributes()), (6, 5));
        for i in (0..6).map(ObjectId::from) {
            for (k, attribute) in scene.attributes().iter().enumerate() {
                let k = AttributeId::from(k);
                assert_eq!(model.values(k), attribute.values.len());
                for v in (0..attribute.values.len()).map(ValueId::from) {
                    assert_eq!(model.has(i, k, v), scene.has(i, k, v));
                    assert_eq!(model.word(k, v), attribute.values[v.index()].word);
                }
            }
            for w in (0..scene.words().len()).map(WordId::from) {
                assert_eq!(model.has_word(i, w), scene.has_word(i, w));
            }
        }
    }

    #[test]
    fn a_word_of_two_attributes_counts_once() {
        let scene = scene(
            r#"{"objects":[
                {"name":"a","attributes":{"peel":"orange","kind":"orange"}},
                {"name":"b","attributes":{"peel":"green"}}],
                "values":{"peel":["orange","green"],"kind":["orange","pear"]}}"#,
        );
        let model = Model::new(&scene, Params::default());
        let orange = scene.word_named("orange").unwrap();
        assert_eq!(model.meanings(orange).len(), 2);
        let mut log = vec![0.0; 2];
        let constant = model.add_log_word(orange, &mut log);
        // |V| = {orange, green, pear}, V_a = {orange}, V_b = {green}.
        assert!(((log[0] + constant).exp() - 1.2 / 1.6).abs() < 1e-15);
        assert!(((log[1] + constant).exp() - 0.2 / 1.6).abs() < 1e-15);
    }

    #[test]
    fn an_object_that_lacks_an_attribute_has_none_of_its_values() {
        let scene = scene(
            r#"{"objects":[{"name":"a","attributes":{"lid":"yes"}},{"name":"b","attributes":{}}],
                "values":{"lid":["yes","no"]}}"#,
        );
        let model = Model::new(&scene, Params::default());
        let lid = AttributeId(0);
        assert_eq!(model.column(lid), [0, Model::LACKS]);
        assert_eq!(model.value(ObjectId(1), lid), None);
        assert!(
            !model.has(ObjectId(1), lid, ValueId(0)) && !model.has(ObjectId(1), lid, ValueId(1))
        );
    }

    #[test]
    #[should_panic(expected = "out of range")]
    fn parameters_out_of_range_are_refused() {
        let _ = Model::new(&bowls(), Params { epsilon: 0.0, ..Params::default() });
    }
}
