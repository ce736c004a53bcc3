//! References of an utterance to earlier ones: "the other one", "the same again", and compared to
//! the object handed over "a smaller one". Comparisons of journals from before there were relations
//! are marks ([`Manager::compared`]).

use scene::{ObjectId, Reading, Reference, Relation, Role, WordId, size_rank};
use vocabulary::Outcome;

use super::Manager;
use super::attribution::Heard;
use super::evidence::Mark;
use super::line::{Content, Remark};
use super::replies::said;
use super::state::{Interaction, State};

/// Relative difference up to which sizes are the same.
const SAME: f64 = 0.01;

/// Returns the reference in the likeliest reading.
pub(super) fn reference(heard: &Heard<'_>) -> Reference {
    heard.interpretations.first().map_or(Reference::None, |(.., reading)| reading.refers)
}

impl Manager {
    /// Returns the object delivered last, if the scene has it.
    pub(super) fn delivered(&self, state: &State) -> Option<ObjectId> {
        let is_delivered = |outcome| matches!(outcome, Outcome::Delivered | Outcome::Refused);
        let ended = state.ended.as_ref().filter(|ended| is_delivered(ended.outcome))?;
        self.setup.scene.object_named(ended.name.as_deref()?)
    }

    /// Returns the objects that a request points to by the one delivered last: of those that its
    /// words describe, or else of those that are most like it.
    pub(super) fn resolve(&self, state: &State, heard: &Heard<'_>) -> Option<Mark> {
        let delivered = self.delivered(state)?;
        let (.., reading) = heard.interpretations.first()?;
        let is_bare = self.says_no_more(reading);
        let fits = |i: &ObjectId| self.fits(reading, *i);
        let objects = self.setup.scene.ids();
        let others: Vec<ObjectId> = objects.filter(|i| *i != delivered && fits(i)).collect();
        let meant = match reading.refers {
            Reference::Same if fits(&delivered) => vec![delivered],
            Reference::Same | Reference::Other => others,
            Reference::Smaller => self.of_other_size(delivered, others, |size, own| size < own),
            Reference::Larger => self.of_other_size(delivered, others, |size, own| size > own),
            Reference::Smallest | Reference::Largest if is_bare => self.of_kind(delivered),
            Reference::Relation(relation @ Relation::More(measure))
                if measure.is_of_object() && reading.further.is_empty() =>
            {
                self.comparable(relation, delivered, others)
            }
            Reference::Relation(Relation::Nth(measure, _)) if measure.is_of_object() && is_bare => {
                self.of_kind(delivered)
            }
            _ => return None,
        };
        // "the smallest" is one of all of its kind.
        let is_one_of_kind = matches!(reading.refers, Reference::Relation(Relation::Nth(..)));
        let is_alike = is_bare && !is_one_of_kind || reading.refers == Reference::Same;
        let meant = if is_alike { self.most_alike(state, delivered, meant) } else { meant };
        match meant[..] {
            [] => Some(self.not(delivered)),
            _ => Some(self.one_of(&meant)),
        }
    }

    /// Returns whether nothing is said beside the reference: "bigger" may also name a value.
    fn says_no_more(&self, reading: &Reading) -> bool {
        let measure = match reading.refers {
            Reference::Relation(Relation::More(measure) | Relation::Nth(measure, 1)) => measure,
            _ => return reading.base.is_empty(),
        };
        reading.base.iter().all(|word| self.setup.scene.is_value_of(*word, measure))
    }

    /// Returns the objects that the robot has just listed, if a request without a kind of thing
    /// fits one of them: "where is the red mug?" … "bring it".
    pub(super) fn listed(&self, state: &State, heard: &Heard<'_>) -> Option<Mark> {
        let objects = match &state.act.line.content {
            Content::Remark(Remark::Objects { objects, .. }) => &objects[..],
            Content::Remark(Remark::OnlyFetches(Some(object))) => std::slice::from_ref(object),
            _ => return None,
        };
        let (.., reading) = heard.interpretations.first().filter(|_| heard.unknown.is_none())?;
        let scene = &self.setup.scene;
        let names_kind = reading
            .base
            .iter()
            .flat_map(|word| self.setup.model.meanings(*word))
            .any(|(k, v)| scene.attributes()[k.index()].values[v.index()].role() == Role::Kind);
        let listed = objects.iter().filter_map(|name| scene.object_named(name));
        let meant: Vec<ObjectId> = listed.filter(|i| self.fits(reading, *i)).collect();
        (!names_kind && !meant.is_empty()).then(|| self.one_of(&meant))
    }

    pub(super) fn one_of(&self, objects: &[ObjectId]) -> Mark {
        let name = |i: &ObjectId| self.setup.scene.object(*i).name.clone();
        Mark::OneOf(objects.iter().map(name).collect())
    }

    /// Returns the objects whose size compares so with that of `object`; all if sizes are unknown.
    fn of_other_size(
        &self,
        object: ObjectId,
        others: Vec<ObjectId>,
        compares: impl Fn(f64, f64) -> bool,
    ) -> Vec<ObjectId> {
        let all = [vec![object], others.clone()].concat();
        let Some(sizes) = self.sizes(&all) else { return others };
        let Some(own) = sizes[0] else { return others };
        let sized = others.into_iter().zip(&sizes[1..]);
        let fits = |size: &Option<f64>| size.is_some_and(|size| compares(size, own));
        sized.filter(|(_, size)| fits(size)).map(|(i, _)| i).collect()
    }

    /// Returns the objects of the same kind, itself included.
    fn of_kind(&self, object: ObjectId) -> Vec<ObjectId> {
        let scene = &self.setup.scene;
        scene.ids().filter(|i| scene.noun_of(*i) == scene.noun_of(object)).collect()
    }

    /// Returns those of the objects most like `object`: in kind, in words used for it, in values.
    fn most_alike(&self, state: &State, object: ObjectId, others: Vec<ObjectId>) -> Vec<ObjectId> {
        let scene = &self.setup.scene;
        let said = state.handed_over.as_ref().map(|it| said(&it.interaction)).unwrap_or_default();
        let said: Vec<WordId> = said.iter().filter_map(|word| scene.word_named(word)).collect();
        let likeness = |i: &ObjectId| {
            let values = scene.object(*i).values.iter().zip(&scene.object(object).values);
            (
                scene.noun_of(*i) == scene.noun_of(object),
                said.iter().filter(|word| scene.has_word(*i, **word)).count(),
                values.filter(|(one, other)| one.is_some() && one == other).count(),
            )
        };
        let most = others.iter().map(likeness).max();
        others.into_iter().filter(|i| Some(likeness(i)) == most).collect()
    }

    /// Returns the objects that a comparison points to, of those that are left.
    pub(super) fn compared(&self, open: &Interaction, reference: Reference) -> Option<Mark> {
        let wants_large = match reference {
            Reference::Smaller | Reference::Smallest => false,
            Reference::Larger | Reference::Largest => true,
            Reference::None | Reference::Any | Reference::Other | Reference::Same => return None,
            Reference::Relation(_) => return None,
        };
        let left = self.left(&open.belief());
        let sizes = self.sizes(&left)?;
        let known = sizes.iter().flatten().copied();
        let best = if wants_large { known.reduce(f64::max) } else { known.reduce(f64::min) }?;
        let is_best = |size: &f64| (size - best).abs() <= SAME * best;
        let meant = left.iter().zip(&sizes).filter(|(_, size)| size.as_ref().is_some_and(is_best));
        let meant: Vec<ObjectId> = meant.map(|(i, _)| *i).collect();
        Some(self.one_of(&meant))
    }

    /// Returns the size of each object as far as it is known: in cubic metres if they differ, else
    /// the rank of its value in an attribute of sizes; `None` if neither distinguishes them.
    fn sizes(&self, objects: &[ObjectId]) -> Option<Vec<Option<f64>>> {
        let scene = &self.setup.scene;
        let volume = |i: &ObjectId| {
            scene.object(*i).placement.map(|placement| placement.size.iter().product::<f64>())
        };
        let rank_in = |k: usize, i: &ObjectId| {
            let value = scene.object(*i).values[k]?;
            let value = &scene.attributes()[k].values[value.index()];
            size_rank(&value.name).map(|rank| rank as f64 + 1.0)
        };
        let differ = |sizes: &Vec<Option<f64>>| {
            let most = sizes.iter().flatten().copied().fold(0.0, f64::max);
            sizes.iter().flatten().any(|size| (most - size) > SAME * most)
        };
        let ranked = |k: usize| objects.iter().map(|i| rank_in(k, i)).collect::<Vec<_>>();
        let volumes: Vec<Option<f64>> = objects.iter().map(volume).collect();
        let mut ranks = (0..scene.attributes().len()).map(ranked);
        Some(volumes).filter(differ).or_else(|| ranks.find(differ))
    }
}
