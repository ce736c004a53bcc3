//! What was said fits no object, or tells those that are left no further: the nearest ones are offered
//! before one of them is fetched.
//!
//! The user, who may not see the objects, learns so what is here. The answer is about the object and
//! not about what the user took it for.

use scene::{AttributeId, ObjectId, Question, ValueId};

use super::acts::set;
use super::line::{AboutObjects, Content, Line, Preface, Remark};
use super::state::{Act, Interaction, State};
use super::{LEFT_MAX, Manager};
use crate::Belief;
use vocabulary::ActKind;

/// Probability that the user takes an object for what it is, below which it does not fit.
const FITS_MIN: f64 = 0.5;
/// Probability from which the user takes an attribute for one value.
const TAKEN_MIN: f64 = 0.5;

impl Manager {
    /// Returns the line with which the object is offered instead of being fetched at once: what was
    /// said does not fit it, or the user cannot tell those that are left apart. None where it was
    /// offered before, or the user takes values for what they are.
    pub(super) fn offer_first(&mut self, state: &State, object: ObjectId) -> Option<Line> {
        let open = state.open.as_ref().filter(|open| !is_offered(open, object))?;
        open.posterior.said()?;
        let misfit = {
            let mut certain = vec![0.0; self.setup.model.objects()];
            certain[object.index()] = 1.0;
            self.fit(open, &certain) < FITS_MIN
        };
        let alike = self.left_over(state, object);
        if alike != Preface::None {
            return Some(Line { preface: alike, content: self.offered_content(vec![object]) });
        }
        misfit.then(|| self.offering(open, object))
    }

    /// Returns the object that is offered, and the line for it, instead of asking a question of that
    /// value: what was said fits nothing, and asking on is worth no more.
    pub(super) fn offer_instead(&mut self, state: &State, value: f64) -> Option<(ObjectId, Line)> {
        let open = state.open.as_ref()?;
        open.posterior.said()?;
        let belief = open.belief();
        if self.fit(open, &belief.probabilities()) >= FITS_MIN {
            return None;
        }
        let mut nearest = self.left(&belief);
        nearest.sort_by(|a, b| belief.probability(*b).total_cmp(&belief.probability(*a)));
        nearest.truncate(LEFT_MAX);
        let object = *nearest.iter().find(|it| !is_offered(open, **it))?;
        let chances: Vec<f64> = nearest.iter().map(|it| belief.probability(*it)).collect();
        let costs = &self.setup.costs;
        (self.worth_of_offers(&chances) >= value - costs.attribute_s)
            .then(|| (object, self.offering(open, object)))
    }

    /// Returns the value of offering objects of these probabilities one after another, until one is
    /// accepted.
    fn worth_of_offers(&self, chances: &[f64]) -> f64 {
        let (costs, params) = (&self.setup.costs, self.setup.model.params());
        let mut left = 1.0;
        let lefts: Vec<f64> = (chances.iter())
            .map(|p| {
                let share = (p / left).min(1.0);
                left = (left - p).max(f64::MIN_POSITIVE);
                share
            })
            .collect();
        let again = 1.0 - costs.discount * (1.0 - params.p_l);
        let discount = costs.discount * params.p_l / again;
        lefts.iter().rev().fold(costs.wait_value(), |denied, right| {
            let right = *right;
            let accepted = costs.pick_value(1.0 - params.epsilon);
            let offered = discount * (right * accepted + (1.0 - right) * denied);
            costs.pick_value(right).max(offered - costs.point_s / again)
        })
    }

    /// How well what was said fits, over objects of these probabilities: for each attribute the
    /// probability that the user takes the object for what it is, times the likelihood of what was said
    /// of that value, relative to the likeliest one's.
    fn fit(&self, open: &Interaction, probabilities: &[f64]) -> f64 {
        let Some(said) = open.posterior.said() else { return 1.0 };
        let model = open.posterior.model(&self.setup.model);
        let attributes = (0..model.attributes()).map(AttributeId::from);
        let told: Vec<(AttributeId, Vec<f64>)> =
            attributes.filter_map(|k| Some((k, said.of(k)?))).collect();
        let fits = |i: ObjectId| -> f64 {
            let own = |(k, likelihood): &(AttributeId, Vec<f64>)| {
                let own = model.value(i, *k)?;
                Some(model.chance(i, *k, own) * likelihood[own.index()])
            };
            told.iter().filter_map(own).product()
        };
        let objects = probabilities.iter().take(model.objects()).enumerate();
        objects.filter(|(_, p)| **p > 0.0).map(|(i, p)| p * fits(i.into())).sum()
    }

    fn offering(&mut self, open: &Interaction, object: ObjectId) -> Line {
        let belief = open.belief();
        let preface = self.nothing_fits(open, &belief);
        let mut nearest = self.left(&belief);
        nearest.sort_by(|a, b| belief.probability(*b).total_cmp(&belief.probability(*a)));
        nearest.retain(|it| *it != object && !is_offered(open, *it));
        nearest.insert(0, object);
        nearest.truncate(LEFT_MAX);
        Line { preface, content: self.offered_content(nearest) }
    }

    fn offered_content(&mut self, objects: Vec<ObjectId>) -> Content {
        Content::Offered(objects.into_iter().map(|it| self.description(it)).collect())
    }

    /// "There are no red pens here.", where that is what the user has described.
    fn nothing_fits(&self, open: &Interaction, belief: &Belief) -> Preface {
        let (scene, model) = (&self.setup.scene, open.posterior.model(&self.setup.model));
        let Some(said) = open.posterior.said() else { return Preface::None };
        let taken = |k: AttributeId| -> Option<ValueId> {
            said.of(k)?;
            let of = |v: ValueId| -> f64 {
                let objects = (0..model.objects()).map(ObjectId::from);
                objects.map(|i| belief.probability(i) * model.chance(i, k, v)).sum()
            };
            (0..model.values(k)).map(ValueId::from).find(|v| of(*v) > TAKEN_MIN)
        };
        let attributes = (0..model.attributes()).map(AttributeId::from);
        let taken: Vec<(AttributeId, ValueId)> =
            attributes.filter_map(|k| Some((k, taken(k)?))).collect();
        let has_all = |i: ObjectId| taken.iter().all(|&(k, v)| model.has(i, k, v));
        if taken.len() < 2 || (0..model.objects()).map(ObjectId::from).any(has_all) {
            return Preface::None;
        }
        let name = |(k, v): &(AttributeId, ValueId)| {
            scene.attributes()[k.index()].values[v.index()].name.clone()
        };
        let words = taken.iter().map(name).collect();
        let (asked, objects) = (AboutObjects::Which, Vec::new());
        Preface::Remark(Remark::Objects { asked, words, objects })
    }

    /// Asks whether the object is wanted.
    pub(super) fn offer(&self, state: &mut State, object: ObjectId, line: Line, reasons: Act) {
        let Some(open) = &mut state.open else { return };
        open.presentations += 1;
        let prompt = self.new_prompt(state, Question::Point(object));
        set(state, Act { kind: ActKind::Ask, prompt, presentation: 1, line, ..reasons });
    }

    /// Returns the question that the standing act puts. What is offered is asked about in words: the
    /// arm does not point.
    pub fn question_put(&self, state: &State) -> Question {
        let offered = state.open.as_ref().filter(|_| state.act.kind == ActKind::Ask);
        let prompt = offered.and_then(|open| open.prompt(state.act.prompt));
        prompt.map_or(state.act.question, |prompt| prompt.question)
    }
}

fn is_offered(open: &Interaction, object: ObjectId) -> bool {
    open.prompts.iter().any(|prompt| prompt.question == Question::Point(object))
}
