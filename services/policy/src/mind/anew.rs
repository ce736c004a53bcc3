//! Other settings under an open interaction: it goes on wherever it can.
//!
//! What was said is scored again from the prior under what holds now, so that objects that are gone
//! drop out and new ones count with everything said so far. The transition reads nothing of the
//! former scene but what the state holds of it in words.

use super::{Mind, posterior, words};
use crate::state::{Interaction, Known, State};
use dialogue::NamedQuestion;
use messages::{ActKind, Outcome, PromptId, UtteranceSeq};
use scene::{ObjectId, Question};
use service::Time;

/// Objects that are remembered by name and words while an interaction is open. Of more it is only
/// told that something has changed.
const KNOWN_MAX: usize = 64;

impl Mind {
    /// Takes note of the settings that hold now.
    pub(super) fn look_anew(&mut self, state: &mut State, at: Time) {
        let same_scene = state.scene_key == self.scene.key();
        (state.scene_key, state.settings_key) = (self.scene.key(), self.key);
        if state.open.is_none() {
            // Its numbers are of the former scene.
            state.act.question = Question::None;
            return;
        }
        if self.nothing_is_left(state) {
            let text = "The scene has changed; please ask me again.";
            return self.close(state, Outcome::SceneChanged, at, text);
        }
        let known = self.known();
        let Some(mut open) = state.open.take() else { return };
        let before = open.belief.clone();
        posterior::store(self.fold(state, &open), &mut open);
        let same_belief = before == open.belief;
        let changed = if same_scene { String::new() } else { self.what_changed(&open, &known) };
        open.objects = known;
        self.translate(state, open);
        // Where neither belief nor objects have changed, the question that stands still stands; other
        // costs count from the next utterance on.
        let is_ordered = matches!(state.act.kind, ActKind::Pick | ActKind::Cancel);
        let is_same = same_scene && same_belief;
        if !is_ordered && !is_same {
            if !changed.is_empty() {
                // It is said with the next question, which is a new one even if it is the same.
                state.act.kind = ActKind::Wait;
            }
            self.decide(state, PromptId(0), &changed, UtteranceSeq(0), at);
            if state.act.kind == ActKind::Pick {
                state.act.text.insert_str(0, &changed);
            }
        }
    }

    /// Whether the ordered object, or every one that there was, is gone.
    fn nothing_is_left(&self, state: &State) -> bool {
        let Some(open) = &state.open else { return true };
        let is_gone = |name: &String| self.scene.object_named(name).is_none();
        if open.pick.is_some() {
            return is_gone(&open.picked);
        }
        !open.objects.is_empty() && open.objects.iter().all(|known| is_gone(&known.name))
    }

    /// Puts the numbers of this scene in place of those of the former.
    fn translate(&self, state: &mut State, mut open: Interaction) {
        let picked = self.scene.object_named(&open.picked);
        open.pick = open.pick.zip(picked).map(|((id, _), object)| (id, object));
        let asked = open.prompts.iter().find(|prompt| prompt.id == state.act.prompt);
        state.act.question = asked.map_or(&NamedQuestion::None, |p| &p.asked).question(&self.scene);
        if state.act.kind == ActKind::Ask && state.act.question == Question::None {
            state.act.kind = ActKind::Wait;
        }
        if state.act.pick.is_some() {
            state.act.pick = open.pick;
        }
        state.open = Some(open);
    }

    /// The objects of the scene in words, unless they are too many.
    pub(super) fn known(&self) -> Vec<Known> {
        let objects = self.scene.objects();
        if objects.len() > KNOWN_MAX {
            return Vec::new();
        }
        let words = |i: usize| self.scene.describe(ObjectId::from(i));
        let known = |(i, object): (usize, &scene::Object)| Known {
            name: object.name.clone(),
            words: words(i),
        };
        objects.iter().enumerate().map(known).collect()
    }

    fn what_changed(&self, open: &Interaction, now: &[Known]) -> String {
        if now.is_empty() || open.objects.is_empty() {
            return format!("The {}s here have changed. ", self.scene.noun());
        }
        let missing_in = |some: &[Known], others: &[Known]| -> Vec<String> {
            let is_missing = |known: &&Known| others.iter().all(|other| other.name != known.name);
            some.iter().filter(is_missing).map(|known| known.words.clone()).collect()
        };
        let gone = missing_in(&open.objects, now);
        let new = missing_in(now, &open.objects);
        words::changes(self.scene.noun(), &gone, &new)
    }
}
