//! Relations by place, order and size as evidence: the truth of "the leftmost", "longer than the
//! red one" for each object is the likelihood of saying so, never certain.

use scene::{
    AttributeId, ObjectId, Question, Reading, Reference, Related, Relation, Response, View, WordId,
};

use super::Manager;
use super::attribution::Heard;
use super::evidence::Mark;
use super::state::Interaction;
use crate::Concessions;

/// Truth below which an object shares the likelihood of all others.
const TRUTH_MIN: f64 = 0.01;
/// Most objects whose likelihoods are remembered one by one.
const NAMED_MAX: usize = 64;

/// A relation in an utterance.
#[derive(Clone, Debug)]
pub(super) struct SaidRelation {
    relation: Relation,
    to: Vec<Vec<ObjectId>>,
    /// Words of the scene next to the relation.
    base: Vec<WordId>,
    /// Share of the interpretations that have it.
    share: f64,
}

impl Manager {
    /// Returns the relation in the likeliest reading; `None` if it is to something unknown.
    pub(super) fn relation(&self, heard: &Heard<'_>) -> Option<SaidRelation> {
        let (_, question, reading) = heard.interpretations.first()?;
        let Reference::Relation(relation) = reading.refers else { return None };
        if let Relation::Nth(measure, 1) | Relation::More(measure) = relation
            && reading.base.iter().any(|word| self.setup.scene.is_value_of(*word, measure))
        {
            // "longer" refers to the scene's word "long".
            return None;
        }
        let named: Vec<Vec<ObjectId>> =
            reading.further.iter().map(|words| self.objects_with(words)).collect();
        if named.iter().any(Vec::is_empty) {
            return None;
        }
        let to = if named.is_empty() { self.spoken_of(*question, reading) } else { named };
        let all: f64 = heard.interpretations.iter().map(|(weight, ..)| weight).sum();
        let same = heard
            .interpretations
            .iter()
            .filter(|(.., it)| (it.refers, &it.further) == (reading.refers, &reading.further));
        let share = same.map(|(weight, ..)| weight).sum::<f64>() / all;
        Some(SaidRelation { relation, to, base: reading.base.clone(), share })
    }

    /// "No, a bigger one", "the one to the left of it": the object asked about, if there is one.
    fn spoken_of(&self, question: Question, reading: &Reading) -> Vec<Vec<ObjectId>> {
        let asked = match question {
            Question::Point(object) => vec![object],
            Question::Attribute(k, v) => {
                self.setup.scene.ids().filter(|i| self.setup.scene.has(*i, k, v)).collect()
            }
            Question::None | Question::Which(_) | Question::Choice(..) => Vec::new(),
        };
        let is_one = asked.len() == 1 && reading.response != Response::Yes;
        if is_one { vec![asked] } else { Vec::new() }
    }

    fn objects_with(&self, words: &[WordId]) -> Vec<ObjectId> {
        let has = |i: &ObjectId| words.iter().all(|word| self.setup.model.has_word(*i, *word));
        self.setup.scene.ids().filter(has).collect()
    }

    /// Returns how likely a relation would be said of each object, of those that are left; `None`
    /// if the scene cannot tell.
    fn likely(&self, open: &Interaction, said: &SaidRelation) -> Option<Mark> {
        let SaidRelation { relation, to, base, share } = said;
        let left = self.left(&open.belief());
        // One that is fetched already is not all that may be meant.
        let among = if left.len() > 1 { left } else { self.objects_with(base) };
        let about = Related { among: &among, to, view: self.view() };
        let truths = self.setup.scene.truths(*relation, &about)?;
        let epsilon = self.setup.model.params().epsilon;
        let any = 1.0 / among.len() as f64;
        let likelihood = |truth: Option<f64>| {
            let of_truth = |truth: f64| {
                (1.0 - epsilon) * truth + epsilon / (among.len() as f64 - 1.0) * (1.0 - truth)
            };
            share * truth.map_or(any, of_truth) + (1.0 - share) * any
        };
        let mut all: Vec<(ObjectId, Option<f64>)> = self.setup.scene.ids().zip(truths).collect();
        all.sort_by(|a, b| b.1.unwrap_or(any).total_cmp(&a.1.unwrap_or(any)));
        let is_named = |(_, truth): &&(ObjectId, Option<f64>)| truth.unwrap_or(any) >= TRUTH_MIN;
        let named = all.iter().take_while(is_named).count().min(NAMED_MAX);
        let (named, rest) = all.split_at(named);
        let others = match rest.len() {
            0 => any,
            count => rest.iter().map(|(_, it)| likelihood(*it)).sum::<f64>() / count as f64,
        };
        let name = |i: ObjectId| self.setup.scene.object(i).name.clone();
        let named = named.iter().map(|(i, truth)| (name(*i), likelihood(*truth))).collect();
        Some(Mark::Likely { named, others })
    }

    /// Updates an interaction with a relation that was said. Returns whether the scene can tell of
    /// which objects it is true.
    pub(super) fn relate(&self, open: &mut Interaction, said: Option<SaidRelation>) -> bool {
        let mark = said.and_then(|said| self.likely(open, &said));
        let is_known = mark.is_some();
        if is_known {
            self.take_in(open, Heard { mark, ..Heard::default() });
        }
        is_known
    }

    /// Returns the user's concessions. Nothing is asked about places in rows while an object
    /// outside all rows may be meant: it may be further left than "the left one".
    pub(super) fn concessions(&self, open: &Interaction) -> Concessions {
        let scene = &self.setup.scene;
        let mut concessions = open.conceded.in_scene(scene);
        let row = scene.attributes().iter().position(|attribute| attribute.by_place);
        let misleads = |k: &usize| {
            let is_in_none = |i: &ObjectId| scene.object(*i).values[*k].is_none();
            self.left(&open.belief()).iter().any(is_in_none)
        };
        concessions.unknown.extend(row.filter(misleads).map(AttributeId::from));
        concessions
    }

    /// Returns the objects, of these, that compare so to the object handed over.
    pub(super) fn comparable(
        &self,
        relation: Relation,
        object: ObjectId,
        others: Vec<ObjectId>,
    ) -> Vec<ObjectId> {
        const PLAIN: f64 = 0.5;
        let among = [vec![object], others.clone()].concat();
        let about = Related { among: &among, to: &[vec![object]], view: self.view() };
        let Some(truths) = self.setup.scene.truths(relation, &about) else { return others };
        let fits = |i: &ObjectId| truths[i.index()].is_some_and(|truth| truth >= PLAIN);
        others.into_iter().filter(fits).collect()
    }

    /// Returns the user's view if the user's place is known, else the robot's.
    fn view(&self) -> View {
        self.setup.gestures.map_or(View::Robot, |(_, user_m)| View::User(user_m))
    }
}
