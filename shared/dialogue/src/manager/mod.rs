//! The dialogue manager: the transition of the dialogue's state. It is pure, deterministic, and the
//! same in the policy service, in the check of its journal, in studies and in simulations.

mod acquaint;
mod acts;
mod answerable;
mod attribution;
mod beliefs;
mod concede;
mod correct;
mod decide;
mod evidence;
mod floor;
mod hand_over;
mod held_back;
mod history;
mod inform;
mod intents;
mod kept;
mod line;
mod misfit;
mod objects;
mod people;
mod pointing;
mod put_back;
mod queue;
mod reconfigure;
mod references;
mod refold;
mod relate;
mod replies;
mod rules;
mod setup;
mod state;
mod stop;
#[cfg(test)]
mod tests;
mod turn;
mod utterance;

pub use concede::Conceded;
pub use evidence::{Evidence, Mark, NAMES_MAX};
pub use floor::{Floor, HEARING_MAX};
pub use hand_over::HandedOver;
pub use held_back::{HeldBack, Wait};
pub use history::History;
pub use line::{AboutObjects, Content, Line, Preface, Reason, Remark};
pub use people::{KnownPerson, PEOPLE_MAX, People, Users};
pub use put_back::{Progress, PuttingBack, WithUser};
pub use refold::{Mismatch, refold, refold_since};
pub use setup::Setup;
pub use state::{
    Act, Basis, Cause, Deferred, Interaction, KnownObject, PROMPTS_MAX, Preference, Prompt, Record,
    Stage, State, Timing,
};
pub use stop::{MotionStop, Stop, StopOrder};
pub use utterance::Utterance;

use acts::{order_again, say, set};
use objects::SceneFile;
use pointing::Pointing;
use scene::{ObjectId, Scene};
use vocabulary::ids::{ActId, InteractionId, PickId, PromptId, UtteranceSeq};
use vocabulary::time::Time;
use vocabulary::{ActKind, Ended, Outcome, PickOutcome, Table, TurnTaking};

use crate::{DecisionProblem, Model, Planner, PolicyTable, rendering};

/// Objects that are named before one of them is picked.
const LEFT_MAX: usize = 3;

/// The dialogue manager of one scene and one decision problem.
pub struct Manager {
    setup: Setup,
    /// Scene file of the setup, if the objects come from perception.
    file: Option<Box<SceneFile>>,
    /// The table that the setup is about.
    table: Option<Table>,
    pointing: Option<Pointing>,
    planner: Box<dyn Planner + Send>,
    /// Descriptions of the objects, as far as they were needed.
    descriptions: Vec<Option<String>>,
    recall: bool,
    key: u64,
    /// Name of the rule that handled the latest utterance.
    rule: &'static str,
}

impl Manager {
    /// Returns the manager of a setup; `key` identifies setup and planner.
    pub fn new(mut setup: Setup, planner: Box<dyn Planner + Send>, key: u64) -> Self {
        let file = setup.perceives.then(|| Box::new(SceneFile::of(&setup)));
        if setup.prior.absent > 0.0 {
            setup.model = setup.model.with_absent();
        }
        let pointing =
            setup.gestures.map(|(model, user_m)| Pointing::new(model, user_m, &setup.scene));
        let descriptions = vec![None; setup.scene.objects().len()];
        let (table, recall) = (None, true);
        let rule = "";
        let mut manager =
            Self { setup, file, table, pointing, planner, descriptions, recall, key, rule };
        manager.follow(&manager.first());
        manager
    }

    /// Keeps no evidence by name in the state: for simulations, whose scene never changes. It
    /// decides the same; a state made so cannot be reconfigured.
    #[must_use]
    pub fn without_recall(self) -> Self {
        Self { recall: false, ..self }
    }

    /// Returns the scene.
    pub fn scene(&self) -> &Scene {
        &self.setup.scene
    }

    /// Returns the observation model.
    pub fn model(&self) -> &Model {
        &self.setup.model
    }

    /// Returns the planner's name.
    pub fn planner(&self) -> &'static str {
        self.planner.name()
    }

    /// Returns the name of the rule that handled the latest utterance, for logs.
    pub fn rule(&self) -> &'static str {
        self.rule
    }

    /// Returns the settings of turn-taking.
    pub fn turns(&self) -> &TurnTaking {
        &self.setup.turns
    }

    /// Replaces the settings of turn-taking: studies compare several.
    pub fn set_turns(&mut self, turns: TurnTaking) {
        self.setup.turns = turns;
    }

    /// Returns the identity of setup and planner.
    pub fn key(&self) -> u64 {
        self.key
    }

    /// Returns the state before anything was said.
    pub fn first(&self) -> State {
        let (scene_key, settings_key) = (self.setup.scene.key(), self.key);
        let table = self.file.is_some().then(Table::default);
        State { scene_key, settings_key, table, ..State::default() }
    }

    /// Advances `state` by `cause`, at time `at`.
    pub fn step(&mut self, state: &mut State, cause: &Cause, at: Time) {
        self.lay(state, cause);
        match cause {
            Cause::Snapshot => {}
            Cause::Utterance(utterance) => self.hear(state, utterance, at),
            Cause::Silence => self.silence(state, at),
            Cause::Quiet => self.decide_deferred(state, at),
            Cause::PickEnded { pick, outcome } => match state.to_put_back() {
                Some((id, _)) if id == *pick => self.end_put_back(state, *outcome, at),
                _ => self.end_pick(state, *pick, *outcome, at),
            },
            Cause::Reconfigured | Cause::Objects(_) => self.reconfigure(state, at),
            Cause::MotionStop(stop) => self.note_stop(state, *stop, at),
            Cause::StopReport { confirmed } => self.report_stop(state, *confirmed, at),
            Cause::SetAside(over) => self.set_aside(state, *over, at),
            Cause::Forget(person) => self.forget_person(state, person, at),
        }
    }

    /// Returns the state that follows from `state` by `cause`, at time `at`.
    pub fn next(&mut self, state: &State, cause: &Cause, at: Time) -> State {
        let mut next = state.clone();
        self.step(&mut next, cause, at);
        next
    }

    /// Returns the decision problem that the planner is asked about.
    pub fn problem(&self) -> DecisionProblem<'_> {
        self.setup.problem()
    }

    /// Lets the planner precompute decisions from the prior of a first interaction, and returns
    /// them if it is a planner that keeps any.
    pub fn precompute(&mut self) -> Option<&PolicyTable> {
        if self.file.is_some() {
            // The first interaction is about objects that are not known yet.
            return None;
        }
        self.planner.table()?;
        let prior = self.prior(&State::default());
        self.planner.prepare(&self.setup.problem(), &prior);
        self.planner.table().filter(|table| !table.is_empty())
    }

    /// Gives the planner decisions precomputed earlier; returns whether they are of its problem.
    pub fn adopt(&mut self, table: PolicyTable) -> bool {
        let fits = self.planner.table().is_some() && table.fits(&self.problem());
        if fits {
            self.planner.adopt(table);
        }
        fits
    }

    /// Returns the decisions that the planner keeps.
    pub fn table(&self) -> Option<&PolicyTable> {
        self.planner.table()
    }

    /// Repeats the question after a silent response window, or abandons the interaction.
    fn silence(&mut self, state: &mut State, at: Time) {
        if state.open.is_none() {
            return;
        }
        self.see_answer(state, false);
        let Some(open) = &mut state.open else { return };
        open.silences += 1;
        let out_of_questions = open.presentations >= self.setup.turns.questions_max;
        if open.silences > self.setup.turns.repeats_max || out_of_questions {
            self.close(state, Outcome::Abandoned, at, Content::Silence);
        } else if self.setup.turns.repeats_same {
            open.presentations += 1;
            self.put_again(state, Preface::None, at);
        } else {
            let (heard, utterance, preference) =
                (state.act.prompt, state.applied, Preference::Otherwise);
            self.decide(state, Basis { heard, utterance, preference, ..Basis::default() }, at);
        }
    }

    fn end_pick(&mut self, state: &mut State, pick: PickId, outcome: PickOutcome, at: Time) {
        let ordered = state.open.as_ref().and_then(|open| open.pick);
        let Some((_, object)) = ordered.filter(|(id, _)| *id == pick) else { return };
        let Some(ends_as) = Outcome::of_pick(outcome) else { return };
        if outcome == PickOutcome::Kept {
            return self.keep_hold(state, object, at);
        }
        if outcome == PickOutcome::Cancelled {
            // The order is still valid: the arm gave it up before a grasp, because it was restarted
            // with another scene.
            if state.act.kind == ActKind::Pick {
                return order_again(state, at);
            }
            if state.open.as_ref().is_some_and(|open| open.corrected) {
                return self.choose_another(state, at);
            }
        }
        let delivered = state.open.as_ref().filter(|_| outcome == PickOutcome::Delivered).cloned();
        if let Some(open) = &delivered {
            state.history.count(&open.picked);
            if state.act.kind == ActKind::Pick {
                self.learn(state, open, object);
            }
            self.hand_over_from_table(state, &open.picked, true);
        }
        let description = self.description(object);
        let is_called_off = state.act.kind == ActKind::Cancel;
        let (content, preface) = match outcome {
            PickOutcome::Delivered if is_called_off => {
                let remark = Remark::TooLate(description);
                (Content::Remark(remark.clone()), Preface::Remark(remark))
            }
            _ => {
                let preface = Preface::PickEnded(description.clone(), outcome);
                (Content::PickEnded(description, outcome), preface)
            }
        };
        let corrected = delivered.as_ref().is_some_and(|open| open.corrected);
        let queue = std::mem::take(&mut state.queue);
        self.close(state, ends_as, at, content);
        if let Some(interaction) = &delivered {
            let (name, interaction) = (interaction.picked.clone(), interaction.id);
            state.with_user = Some(WithUser { name, interaction, at });
        }
        state.handed_over = delivered.map(|interaction| {
            let interaction = Interaction { deferred: None, ..interaction };
            HandedOver { interaction, at, lines: vec![state.last_prompt] }
        });
        use PickOutcome::{Delivered, Missed, Unreachable, Vanished};
        let goes_on = [Delivered, Unreachable, Missed, Vanished];
        if goes_on.contains(&outcome) {
            state.queue = queue;
        }
        if state.putting_back.is_some() {
            self.put_back_in_turn(state, (preface, outcome), at);
        } else if corrected {
            self.fetch_wanted(state, preface, at);
        } else if !state.queue.is_empty() {
            self.serve_queue(state, preface, at);
        }
    }

    /// Ends the interaction and says so.
    fn close(&self, state: &mut State, outcome: Outcome, at: Time, content: Content) {
        let Some(open) = state.open.take() else { return };
        state.queue.clear();
        if let Some(with_user) = &mut state.with_user {
            with_user.at = at;
        }
        let questions = open.questions;
        if let Some(person) = open.posterior.person() {
            state.users.person = Some(person.clone());
        }
        state.ended = Some(Ended {
            interaction: open.id,
            object: open.pick.map(|(_, object)| self.setup.scene.number(object)),
            name: open.pick.map(|_| open.picked),
            outcome,
            questions,
            seconds: at.since(open.opened).s(),
            utterances: open.utterances,
        });
        say(state, content, at);
    }

    /// Ends every number up to `over`, and with them the open interaction, whose utterances may be
    /// lost.
    fn set_aside(&self, state: &mut State, over: u64, at: Time) {
        state.applied = state.applied.max(UtteranceSeq(over));
        state.last_interaction = state.last_interaction.max(InteractionId(over));
        state.last_prompt = state.last_prompt.max(PromptId(over));
        state.act.id = state.act.id.max(ActId(over));
        (state.handed_over, state.with_user, state.putting_back) = (None, None, None);
        if state.open.is_some() {
            self.close(state, Outcome::Abandoned, at, Content::Forgotten);
        } else {
            set(state, Act { utterance: state.applied, decided: at, ..Act::default() });
        }
    }

    /// Returns the description of an object, unique in the scene.
    fn description(&mut self, object: ObjectId) -> String {
        let known = &mut self.descriptions[object.index()];
        known.get_or_insert_with(|| rendering::object(&self.setup.scene, object)).clone()
    }
}
