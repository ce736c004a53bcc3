//! The observation model's tables for one scene.

use scene::{AttributeId, ObjectId, Question, Scene, ValueId, WordId};

use crate::Params;

/// What equations (4)–(7) need of a scene, attribute by attribute.
///
/// Values lie column-wise (one small integer per object and attribute), so that the likelihood of
/// a word or an answer is one pass over one column, for thousands of objects alike.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    params: Params,
    objects: usize,
    columns: Vec<Column>,
    words: Vec<Vec<(AttributeId, ValueId)>>,
    /// `ln(|V_D| + α|V|)` per object: the denominator of eq. (5).
    log_vocabulary: Vec<f64>,
}

/// One attribute: the value of every object, and the word of every value.
#[derive(Clone, Debug, PartialEq)]
struct Column {
    values: Vec<u16>,
    words: Vec<WordId>,
}

impl Model {
    /// Stands in a column for an object that lacks the attribute.
    pub const LACKS: u16 = u16::MAX;

    /// The tables of a scene.
    ///
    /// # Panics
    /// If the parameters are out of range: [`Params::check`] says which.
    pub fn new(scene: &Scene, params: Params) -> Self {
        assert!(params.check().is_empty(), "parameters out of range: {params:?}");
        let columns: Vec<Column> = (0..scene.attributes().len())
            .map(|k| Column::of(scene, AttributeId::from(k)))
            .collect();
        let mut words = vec![Vec::new(); scene.words().len()];
        for (k, column) in columns.iter().enumerate() {
            for (v, word) in column.words.iter().enumerate() {
                words[word.index()].push((AttributeId::from(k), ValueId::from(v)));
            }
        }
        let smoothing = params.alpha * scene.words().len() as f64;
        let log_vocabulary = (0..scene.objects().len())
            .map(|i| (scene.vocabulary_len(ObjectId::from(i)) as f64 + smoothing).ln())
            .collect();
        Self { params, objects: scene.objects().len(), columns, words, log_vocabulary }
    }

    /// `p_l`, `ε` and `α`.
    pub fn params(&self) -> Params {
        self.params
    }

    /// `|I|`: how many objects there are.
    pub fn objects(&self) -> usize {
        self.objects
    }

    /// `|K|`: how many attributes there are.
    pub fn attributes(&self) -> usize {
        self.columns.len()
    }

    /// `|V_k|`: how many values the attribute can have, whether or not an object has them.
    pub fn values(&self, k: AttributeId) -> usize {
        self.columns[k.index()].words.len()
    }

    /// The value index of every object for attribute `k`, or [`Model::LACKS`].
    pub fn column(&self, k: AttributeId) -> &[u16] {
        &self.columns[k.index()].values
    }

    /// The word that value `v` of attribute `k` is.
    pub fn word(&self, k: AttributeId, v: ValueId) -> WordId {
        self.columns[k.index()].words[v.index()]
    }

    /// The attributes and values that a word stands for: one, or more where attributes share it.
    pub fn meanings(&self, word: WordId) -> &[(AttributeId, ValueId)] {
        &self.words[word.index()]
    }

    /// The value of object `i` for attribute `k`, if it has one.
    pub fn value(&self, i: ObjectId, k: AttributeId) -> Option<ValueId> {
        let value = self.column(k)[i.index()];
        (value != Self::LACKS).then_some(ValueId(value))
    }

    /// `attr_k,v(i)`: false for an object that lacks the attribute.
    pub fn has(&self, i: ObjectId, k: AttributeId, v: ValueId) -> bool {
        self.column(k)[i.index()] == v.0
    }

    /// `1_{V_D}(w)` with `D = i`.
    pub fn has_word(&self, i: ObjectId, word: WordId) -> bool {
        self.meanings(word).iter().any(|&(k, v)| self.has(i, k, v))
    }

    /// Whether the question is about an object, attribute and value of this scene.
    pub fn contains(&self, question: Question) -> bool {
        match question {
            Question::None => true,
            Question::Point(i) => i.index() < self.objects,
            Question::Which(k) => k.index() < self.columns.len(),
            Question::Attribute(k, v) => {
                k.index() < self.columns.len() && v.index() < self.values(k)
            }
        }
    }

    /// `ln P(w | D)` of eq. (5), added to the entry of every object.
    pub(crate) fn add_log_word(&self, word: WordId, out: &mut [f64]) {
        let own = (1.0 + self.params.alpha).ln();
        let other = self.params.alpha.ln();
        match self.meanings(word) {
            &[(k, v)] => {
                let objects = out.iter_mut().zip(self.column(k)).zip(&self.log_vocabulary);
                for ((entry, &value), vocabulary) in objects {
                    *entry += if value == v.0 { own } else { other } - vocabulary;
                }
            }
            _ => {
                for (i, entry) in out.iter_mut().enumerate() {
                    let factor = if self.has_word(ObjectId::from(i), word) { own } else { other };
                    *entry += factor - self.log_vocabulary[i];
                }
            }
        }
    }
}

impl Column {
    fn of(scene: &Scene, k: AttributeId) -> Self {
        let values = (scene.objects().iter())
            .map(|object| object.values[k.index()].map_or(Model::LACKS, |v| v.0))
            .collect();
        let words = scene.attributes()[k.index()].values.iter().map(|value| value.word).collect();
        Self { values, words }
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
                    assert_eq!(model.word(k, v), scene.word_of(k, v));
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
        model.add_log_word(orange, &mut log);
        // |V| = {orange, green, pear}, V_a = {orange}, V_b = {green}.
        assert!((log[0].exp() - 1.2 / 1.6).abs() < 1e-15);
        assert!((log[1].exp() - 0.2 / 1.6).abs() < 1e-15);
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
