//! What an utterance points to by what was spoken of: "the other one", "the same again", "the smaller
//! one".

use scene::{ObjectId, Reference};

use super::Manager;
use super::attribution::Heard;
use super::evidence::Mark;
use super::state::{Interaction, State};
use crate::Outcome;

/// Names of sizes, from small to large; values of an attribute that has no other names are ordered by
/// it.
const SIZES: [&[&str]; 5] = [
    &["tiny", "mini"],
    &["small", "little", "short", "thin", "narrow", "low"],
    &["medium", "middle", "mid-size"],
    &["big", "large", "long", "tall", "thick", "wide", "high"],
    &["huge", "giant", "gigantic", "enormous"],
];

/// Relative difference up to which sizes are the same.
const SAME: f64 = 0.01;

/// Returns what the likeliest reading points to.
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

    /// Returns what a request points to that was spoken of before it.
    pub(super) fn resolve(&self, state: &State, reference: Reference) -> Option<Mark> {
        let delivered = self.delivered(state)?;
        match reference {
            Reference::Other | Reference::Smaller | Reference::Larger => Some(self.not(delivered)),
            Reference::Same => {
                Some(Mark::OneOf(vec![self.setup.scene.object(delivered).name.clone()]))
            }
            Reference::None | Reference::Any | Reference::Smallest | Reference::Largest => None,
        }
    }

    /// Returns the objects that a comparison points to, of those that are left.
    pub(super) fn compared(&self, open: &Interaction, reference: Reference) -> Option<Mark> {
        let wants_large = match reference {
            Reference::Smaller | Reference::Smallest => false,
            Reference::Larger | Reference::Largest => true,
            Reference::None | Reference::Any | Reference::Other | Reference::Same => return None,
        };
        let left = self.left(&open.belief());
        let sizes = self.sizes(&left)?;
        let extreme =
            |best: f64, size: &f64| if wants_large { best.max(*size) } else { best.min(*size) };
        let first = *sizes.first()?;
        let best = sizes.iter().fold(first, extreme);
        let meant =
            left.iter().zip(&sizes).filter(|(_, size)| (**size - best).abs() <= SAME * best);
        let names = meant.map(|(i, _)| self.setup.scene.object(*i).name.clone()).collect();
        Some(Mark::OneOf(names))
    }

    /// Returns the size of each object: in cubic metres where they differ, else the rank of its value
    /// in an attribute of sizes; none where neither tells them apart.
    fn sizes(&self, objects: &[ObjectId]) -> Option<Vec<f64>> {
        let scene = &self.setup.scene;
        let volume = |i: &ObjectId| {
            scene.object(*i).placement.map(|placement| placement.size.iter().product::<f64>())
        };
        let rank_in = |k: usize, i: &ObjectId| {
            let value = scene.object(*i).values[k]?;
            let value = &scene.attributes()[k].values[value.index()];
            let is_named = |names: &&[&str]| names.contains(&value.name.as_str());
            SIZES.iter().position(is_named).map(|rank| rank as f64 + 1.0)
        };
        let differ = |sizes: &Vec<f64>| {
            let most = sizes.iter().copied().fold(0.0, f64::max);
            sizes.iter().any(|size| (most - size) > SAME * most)
        };
        let ranked = |k: usize| objects.iter().map(|i| rank_in(k, i)).collect::<Option<Vec<f64>>>();
        let volumes: Option<Vec<f64>> = objects.iter().map(volume).collect();
        let mut ranks = (0..scene.attributes().len()).filter_map(ranked);
        volumes.filter(differ).or_else(|| ranks.find(differ))
    }
}
