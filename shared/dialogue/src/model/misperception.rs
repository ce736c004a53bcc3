//! Users who take a value for another one.

use std::sync::Arc;

use scene::{AttributeId, ValueId};
use vocabulary::Params;

use super::Model;

impl Model {
    /// The model of a user who takes the object's value of attribute `k` for another one with
    /// probability `rates[k]`, each other value alike, and sticks to it: every word and answer
    /// about the attribute is about the value that the user takes it for. With the same rate the
    /// user gives a value, each alike, to an object for which the scene states none ("the tomato
    /// ketchup"): scenes are incomplete. Without a rate above 0 the model stays as it is.
    ///
    /// # Panics
    /// If there is not a rate from 0 to below 1 for each attribute, or the model has a hypothesis
    /// beyond the objects already.
    #[must_use]
    pub fn with_misperceptions(mut self, rates: &[f64]) -> Self {
        assert_eq!(rates.len(), self.attributes(), "a rate for each attribute");
        assert!(rates.iter().all(|rate| (0.0..1.0).contains(rate)), "{rates:?} are not rates");
        assert!(!self.absent, "the objects' values come first");
        if rates.iter().all(|rate| *rate == 0.0) {
            return self;
        }
        self.misperceive(|k| rates[k.index()]);
        self
    }

    fn misperceive(&mut self, rate: impl Fn(AttributeId) -> f64) {
        self.plain = Some(Box::new(self.clone()));
        let tables = Arc::make_mut(&mut self.tables);
        for (k, column) in tables.columns.iter_mut().enumerate() {
            column.misperceive(rate(k.into()));
        }
        tables.find_what_splits();
    }

    /// The model of a person with these parameters, with that `α` of words and of words that are
    /// certain, and these rates of misperception, if users mistake values at all.
    #[must_use]
    pub(crate) fn of_person(
        &self,
        params: Params,
        [alpha, certain]: [f64; 2],
        rate: impl Fn(AttributeId) -> f64,
    ) -> Self {
        let mut model = self.plain().with_params(params);
        // Persons come and go: tables of decisions are for recurring models.
        model.is_of_interaction = true;
        if [alpha, certain] != [false, true].map(|is_certain| model.smoothing(is_certain)) {
            let objects = model.objects;
            Arc::make_mut(&mut model.tables).smooth(objects, alpha, certain);
        }
        if self.misperceives() {
            model.misperceive(rate);
        }
        model
    }

    /// Probability that the user takes a value of attribute `k` for another one.
    pub(crate) fn misperceived(&self, k: AttributeId) -> f64 {
        self.tables.columns[k.index()].misperceived
    }

    /// The model for planning: attributes that were mentioned, according to `told`, are as the user
    /// perceives them. All others are as they are, and their answers wrong as often as by
    /// misperception and error together: a search assumes independent answers given the object, so
    /// it would rely on repeated questions that bring nothing new.
    #[must_use]
    pub(crate) fn planned(&self, told: impl Fn(AttributeId) -> bool) -> Self {
        let mut model = self.plain().clone();
        if self.misperceives() {
            model = model.with_params(self.params.with_more_errors(self.tables.misperceived()));
        }
        let told: Vec<usize> = (0..self.attributes()).filter(|k| told((*k).into())).collect();
        if self.misperceives() && !told.is_empty() {
            let tables = Arc::make_mut(&mut model.tables);
            for k in told {
                tables.columns[k].clone_from(&self.tables.columns[k]);
            }
            tables.find_what_splits();
            model.is_of_interaction = self.is_of_interaction;
        }
        model
    }

    /// The model of a user who never mistakes values.
    pub(crate) fn plain(&self) -> &Self {
        self.plain.as_deref().unwrap_or(self)
    }

    /// Whether the user may take a value for another one.
    pub fn misperceives(&self) -> bool {
        self.plain.is_some()
    }

    /// The value of an entry that only the user may take for another one.
    pub(crate) fn known(&self, k: AttributeId, entry: u16) -> Option<ValueId> {
        let doubt = entry.checked_sub(Self::DOUBTFUL).filter(|_| entry < Self::UNKNOWN)?;
        self.tables.columns[k.index()].known.get(usize::from(doubt)).copied().flatten()
    }

    /// Whether values in doubt were updated with the words of an interaction, so that the model
    /// will hardly recur.
    pub(crate) fn is_of_interaction(&self) -> bool {
        self.is_of_interaction
    }
}
