//! Eq. (5): the likelihood of a word under every hypothesis.

use scene::{ObjectId, WordId};

use super::Model;
use super::tables::{Smoothing, Vocabulary};

impl Model {
    /// Mean of [`Model::word_chance`] over the objects.
    pub(crate) fn mean_word_chance(&self, word: WordId) -> f64 {
        let all = (0..self.objects).map(|i| self.word_chance(i.into(), word));
        all.sum::<f64>() / self.objects as f64
    }

    /// `|V|`: how many words there are.
    pub(crate) fn words(&self) -> usize {
        self.tables.words.len()
    }

    /// Mean of `|V_D|` over the objects.
    pub(crate) fn mean_own_words(&self) -> f64 {
        let lengths = self.tables.vocabulary_lengths(self.objects);
        lengths.iter().sum::<usize>() as f64 / self.objects as f64
    }

    /// The words that may have been said if one was heard with a doubt, each with its share.
    pub(crate) fn said_instead(
        &self,
        word: WordId,
        doubt: f64,
    ) -> impl Iterator<Item = (WordId, f64)> + '_ {
        self.tables.confusion.said_instead(word, doubt)
    }

    /// The denominator of eq. (5), and the weight of an object's own word: the information in a
    /// word beyond its value. Added to every entry but for a constant that is returned.
    pub(crate) fn add_vocabulary(&self, is_certain: bool, out: &mut [f64]) -> f64 {
        let tables = &*self.tables;
        let Smoothing { alpha, vocabulary } =
            if is_certain { &tables.certain } else { &tables.smoothing };
        out.iter_mut().zip(&vocabulary.above).for_each(|(entry, above)| *entry -= above);
        (1.0 + alpha).ln() - vocabulary.least
    }

    /// `ln P(w | D)` of eq. (5), but for a constant that is returned, added to every entry. The
    /// constant is chosen so that entries only fall.
    pub(crate) fn add_log_word(&self, word: WordId, out: &mut [f64]) -> f64 {
        if self.is_doubtful_word(word) {
            return self.add_doubted_word(word, 0.0, out);
        }
        let Smoothing { alpha, vocabulary } = &self.tables.certain;
        let own = (1.0 + alpha).ln();
        let other = alpha.ln() - own;
        let constant = own - vocabulary.least;
        if !self.tables.words[word.index()].splits {
            let has = self.has_word(ObjectId(0), word);
            return if has { constant } else { constant + other };
        }
        let entries = out.iter_mut().zip(&vocabulary.above);
        match self.meanings(word) {
            &[(k, v)] => {
                for ((entry, above), &value) in entries.zip(self.column(k)) {
                    let factor = if value == v.0 { 0.0 } else { other };
                    *entry += factor - above;
                }
            }
            _ => {
                for (i, (entry, above)) in entries.enumerate() {
                    let factor = if self.has_word(ObjectId::from(i), word) { 0.0 } else { other };
                    *entry += factor - above;
                }
            }
        }
        constant
    }

    /// As [`Model::add_log_word`] for a word that was said with `1 − doubt`, and else was one that
    /// is taken for it: `ln ((1−d) P(w|D) + d Σ_u κ(u|w) P(u|D))`.
    pub(crate) fn add_doubted_word(&self, word: WordId, doubt: f64, out: &mut [f64]) -> f64 {
        let tables = &*self.tables;
        let is_certain = doubt <= crate::CERTAIN_DOUBT;
        let Smoothing { alpha, vocabulary } =
            if is_certain { &tables.certain } else { &tables.smoothing };
        let Vocabulary { least, above } = vocabulary;
        let mut said = vec![*alpha; out.len()];
        for (u, share) in tables.confusion.said_instead(word, doubt) {
            if self.is_doubtful_word(u) {
                let chance = |i: usize| self.word_chance(ObjectId::from(i), u);
                said.iter_mut().enumerate().for_each(|(i, s)| *s += share * chance(i));
                continue;
            }
            let own = |i: usize| self.has_word(ObjectId::from(i), u);
            said.iter_mut().enumerate().filter(|(i, _)| own(*i)).for_each(|(_, s)| *s += share);
        }
        let constant = (1.0 + alpha).ln() - least;
        for ((entry, said), above) in out.iter_mut().zip(said).zip(above) {
            *entry += (said / (1.0 + alpha)).ln() - above;
        }
        constant
    }
}
