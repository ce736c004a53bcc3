//! Offers: if the description fits no object, or does not distinguish the last ones, the nearest
//! ones are offered before one is fetched.
//!
//! In this way a user in another room learns which objects are here. The answer is about the
//! object, no longer about the user's perception of it.

use scene::{AttributeId, ObjectId, Question, ValueId};

use super::acts::set;
use super::line::{AboutObjects, Content, Line, Preface, Remark};
use super::state::{Act, Interaction, Preference, State};
use super::{LEFT_MAX, Manager};
use crate::Belief;
use crate::planning::Price;
use vocabulary::ActKind;

/// Probability that the user perceives an object correctly, below which it does not fit.
const FITS_MIN: f64 = 0.5;
/// Probability from which the user takes an attribute for one value.
const TAKEN_MIN: f64 = 0.5;

/// Offers of an object to a user who does not answer them.
const OFFERS_MAX: usize = 2;

/// An object that is offered, and the line for it.
pub(super) type Offered = (ObjectId, Line);

impl Manager {
    /// Returns the offer of the object to be fetched now, if the description does not fit it, or if
    /// the user cannot distinguish it from others, which `alike` names: then a second time, if the
    /// user has said neither which one nor, by `preference`, that either will do. Only users who
    /// may mistake values get offers.
    pub(super) fn offer_first(
        &mut self,
        state: &State,
        object: ObjectId,
        (alike, preference): (&Preface, Preference),
    ) -> Option<Offered> {
        let is_unanswered = *alike != Preface::None && preference == Preference::Best;
        let most = if is_unanswered { OFFERS_MAX } else { 1 };
        let open = state.open.as_ref().filter(|open| offers(open, object) < most)?;
        // An absent object is concluded, and cannot be offered.
        let is_here = Some(object) != self.setup.model.absent();
        let fit = self.fit(open, |i| f64::from(u8::from(i == object))).filter(|_| is_here)?;
        if *alike != Preface::None {
            let content = Content::Offered(vec![self.description(object)]);
            return Some((object, Line { preface: alike.clone(), content }));
        }
        (fit < FITS_MIN).then(|| (object, self.offering(open, object)))
    }

    /// Returns the offer to make instead of asking a question of that value: the description fits
    /// no object, and further questions are worth no more.
    pub(super) fn offer_instead(&mut self, state: &State, value: f64) -> Option<Offered> {
        let open = state.open.as_ref()?;
        let belief = open.belief();
        if self.fit(open, |i| belief.probability(i))? >= FITS_MIN {
            return None;
        }
        let mut nearest = self.left_by_probability(&belief);
        nearest.truncate(LEFT_MAX);
        let object = *nearest.iter().find(|it| !is_offered(open, **it))?;
        let chances: Vec<f64> = nearest.iter().map(|it| belief.probability(*it)).collect();
        let is_worth = self.worth_of_offers(&chances) >= value - self.setup.costs.attribute_s;
        is_worth.then(|| (object, self.offering(open, object)))
    }

    /// Returns the value of offering objects of these probabilities in turn, until one is accepted.
    fn worth_of_offers(&self, chances: &[f64]) -> f64 {
        let (costs, params) = (&self.setup.costs, self.setup.model.params());
        let price = Price::new(costs, costs.point_s, 1.0 - params.p_l);
        let accepted = costs.pick_value(1.0 - params.epsilon);
        let mut left = 1.0;
        let mut rights = Vec::new();
        for chance in chances {
            rights.push((chance / left).min(1.0));
            left = (left - chance).max(f64::MIN_POSITIVE);
        }
        rights.into_iter().rev().fold(costs.wait_value(), |denied, right| {
            costs.pick_value(right).max(price.pay(right * accepted + (1.0 - right) * denied))
        })
    }

    /// Returns the fit of the description, averaged over the objects: for each attribute the
    /// probability that the user perceives the object correctly, times the likelihood of the words
    /// for that value, relative to the likeliest. `None` for a user who never mistakes values.
    fn fit(&self, open: &Interaction, probability: impl Fn(ObjectId) -> f64) -> Option<f64> {
        let said = open.posterior.said()?;
        let model = open.posterior.model(&self.setup.model);
        let attributes = (0..model.attributes()).map(AttributeId::from);
        let known: Vec<(AttributeId, Vec<f64>)> =
            attributes.filter_map(|k| Some((k, said.of(k)?))).collect();
        let fits = |i: ObjectId| -> f64 {
            let own = |(k, likelihood): &(AttributeId, Vec<f64>)| {
                let own = model.value(i, *k)?;
                Some(model.chance(i, *k, own) * likelihood[own.index()])
            };
            known.iter().filter_map(own).product()
        };
        Some(self.setup.scene.ids().map(|i| probability(i) * fits(i)).sum())
    }

    /// Returns the line that offers an object: the absent values, and the nearest object.
    fn offering(&mut self, open: &Interaction, object: ObjectId) -> Line {
        let belief = open.belief();
        let preface = self.nothing_fits(open, &belief);
        let mut nearest = self.left_by_probability(&belief);
        nearest.retain(|it| *it != object && !is_offered(open, *it));
        nearest.insert(0, object);
        nearest.truncate(LEFT_MAX);
        let descriptions = nearest.into_iter().map(|it| self.description(it)).collect();
        Line { preface, content: Content::Offered(descriptions) }
    }

    /// "There are no red pens here.", if the user has described one.
    fn nothing_fits(&self, open: &Interaction, belief: &Belief) -> Preface {
        let (scene, model) = (&self.setup.scene, open.posterior.model(&self.setup.model));
        let Some(said) = open.posterior.said() else { return Preface::None };
        let taken = |k: AttributeId| -> Option<ValueId> {
            said.of(k)?;
            let of = |v: ValueId| -> f64 {
                scene.ids().map(|i| belief.probability(i) * model.chance(i, k, v)).sum()
            };
            (0..model.values(k)).map(ValueId::from).find(|v| of(*v) > TAKEN_MIN)
        };
        let attributes = (0..model.attributes()).map(AttributeId::from);
        let taken: Vec<(AttributeId, ValueId)> =
            attributes.filter_map(|k| Some((k, taken(k)?))).collect();
        let has_all = |i: ObjectId| taken.iter().all(|&(k, v)| model.has(i, k, v));
        if taken.len() < 2 || scene.ids().any(has_all) {
            return Preface::None;
        }
        let name = |(k, v): &(AttributeId, ValueId)| {
            scene.attributes()[k.index()].values[v.index()].name.clone()
        };
        let words = taken.iter().map(name).collect();
        let (asked, objects) = (AboutObjects::Which, Vec::new());
        Preface::Remark(Remark::Objects { asked, words, objects })
    }

    /// Asks whether the object is wanted, after the remark that was due if the offer has none.
    pub(super) fn offer(&self, state: &mut State, offered: Offered, due: Preface, reasons: Act) {
        let (object, mut line) = offered;
        if line.preface == Preface::None {
            line.preface = due;
        }
        let Some(open) = &mut state.open else { return };
        open.presentations += 1;
        let question = Question::Point(object);
        let prompt = self.new_prompt(state, question);
        set(state, Act { kind: ActKind::Ask, prompt, presentation: 1, question, line, ..reasons });
    }
}

impl Act {
    /// Returns whether the object in question is named in words alone, and not pointed at.
    pub fn is_in_words(&self) -> bool {
        matches!(self.line.content, Content::Offered(_))
    }
}

fn is_offered(open: &Interaction, object: ObjectId) -> bool {
    offers(open, object) > 0
}

fn offers(open: &Interaction, object: ObjectId) -> usize {
    open.prompts.iter().filter(|prompt| prompt.question == Question::Point(object)).count()
}
