//! Other settings under an open interaction: it continues wherever possible.
//!
//! The evidence is scored again from the prior under the present scene, so that objects that are
//! gone drop out and new ones count with everything said so far. The transition reads nothing of
//! the former scene but the names in the state.

use scene::{ObjectId, Question};
use vocabulary::time::Time;
use vocabulary::{ActKind, Outcome};

use super::Manager;
use super::line::{Content, Preface};
use super::state::{Basis, Interaction, KnownObject, State};

/// Objects that are remembered by name and description while an interaction is open. With more, the
/// robot only says that something has changed.
const KNOWN_MAX: usize = 64;

impl Manager {
    /// Continues under the present settings.
    pub(super) fn reconfigure(&mut self, state: &mut State, at: Time) {
        let same_scene = state.scene_key == self.setup.scene.key();
        (state.scene_key, state.settings_key) = (self.setup.scene.key(), self.key);
        if !same_scene {
            // Their numbers belong to the former scene.
            state.act.alternatives.clear();
            let kept = state.table.is_some();
            state.handed_over = (state.handed_over.take())
                .filter(|_| kept)
                .and_then(|mut it| self.keep_delivery(&mut it.interaction).then_some(it));
            if state.to_put_back().is_some() {
                // The arm gives up the order.
                (state.act.kind, state.act.pick) = (ActKind::Wait, None);
            }
            let is_known = |name: &str| self.setup.scene.object_named(name).is_some();
            state.with_user = state.with_user.take().filter(|it| kept && is_known(&it.name));
            state.putting_back = None;
        }
        if state.open.is_none() {
            state.act.question = Question::None;
            return;
        }
        if state.table.is_none() && self.nothing_is_left(state) {
            return self.close(state, Outcome::SceneChanged, at, Content::SceneReplaced);
        }
        let known = self.known_objects();
        let Some(mut open) = state.open.take() else { return };
        let posterior = self.fold(state, &open);
        let same_belief = open.belief() == posterior.belief();
        open.posterior = posterior;
        let changes = if same_scene { Preface::None } else { changes(&open.objects, &known) };
        open.objects = known;
        self.translate(state, open);
        // If neither belief nor objects have changed, the pending question remains; new costs count
        // from the next utterance on.
        let is_ordered = state.ordered().is_some();
        if is_ordered || (same_scene && same_belief) {
            return;
        }
        if changes != Preface::None {
            // It is said with the next question, which is a new one even if it is the same.
            state.act.kind = ActKind::Wait;
        }
        self.decide(state, Basis { preface: changes.clone(), ..Basis::default() }, at);
        if state.act.kind == ActKind::Pick {
            state.act.line.preface = changes;
        }
    }

    /// Returns whether the ordered object, or every object that there was, is gone.
    fn nothing_is_left(&self, state: &State) -> bool {
        let Some(open) = &state.open else { return true };
        let is_gone = |name: &String| self.setup.scene.object_named(name).is_none();
        if open.pick.is_some() {
            return is_gone(&open.picked);
        }
        !open.objects.is_empty() && open.objects.iter().all(|known| is_gone(&known.name))
    }

    /// Replaces the former scene's numbers by those of the present one.
    fn translate(&self, state: &mut State, mut open: Interaction) {
        let picked = self.setup.scene.object_named(&open.picked);
        open.pick = open.pick.zip(picked).map(|((id, _), object)| (id, object));
        for prompt in &mut open.prompts {
            prompt.question = prompt.named.question(&self.setup.scene);
        }
        let asked = open.prompt(state.act.prompt);
        state.act.question = asked.map_or(Question::None, |prompt| prompt.question);
        if state.act.kind == ActKind::Ask && state.act.question == Question::None {
            state.act.kind = ActKind::Wait;
        }
        if state.act.pick.is_some() {
            state.act.pick = open.pick;
        }
        state.open = Some(open);
    }

    /// Returns the scene's objects by name, unless they are too many or never needed.
    pub(super) fn known_objects(&mut self) -> Vec<KnownObject> {
        let objects = self.setup.scene.objects().len();
        if objects > KNOWN_MAX || !self.recall {
            return Vec::new();
        }
        let stands: Vec<ObjectId> = (0..objects)
            .map(ObjectId::from)
            .filter(|object| !self.setup.scene.object(*object).taken)
            .collect();
        let known = |object: ObjectId| KnownObject {
            description: self.description(object),
            name: self.setup.scene.object(object).name.clone(),
        };
        stands.into_iter().map(known).collect()
    }
}

/// Returns the remark on the objects that are gone and new.
fn changes(before: &[KnownObject], now: &[KnownObject]) -> Preface {
    if now.is_empty() || before.is_empty() {
        return Preface::SceneChanged;
    }
    let missing_in = |some: &[KnownObject], others: &[KnownObject]| -> Vec<String> {
        let is_missing = |known: &&KnownObject| others.iter().all(|it| it.name != known.name);
        some.iter().filter(is_missing).map(|known| known.description.clone()).collect()
    };
    let (gone, new) = (missing_in(before, now), missing_in(now, before));
    if gone.is_empty() && new.is_empty() {
        return Preface::None;
    }
    Preface::ObjectsChanged { gone, new }
}
