//! The transition of the dialogue's state: pure, deterministic, and the same in the service, in a
//! check of its journal, and in simulation.

mod acts;
mod addressed;
mod ahead;
mod anew;
mod correct;
mod inform;
mod intents;
mod pointing;
mod posterior;
mod prior;
mod words;

use crate::state::{Act, Cause, Interaction, State};
use acts::{ask, keep_words, order_again, pick, repeat, say, set};
use dialogue::gesture::Gestures;
use dialogue::{
    Action, Actions, Confusion, Costs, DecisionProblem, Durations, Model, Params, Planner, Prior,
    Step, TurnTaking,
};
use messages::{ActKind, Ended, Outcome, PickId, PickOutcome, PromptId, UtteranceSeq};
use pointing::Pointing;
use scene::Scene;
use service::Time;

/// What is taken to be true of people, and what is wanted of the robot.
#[derive(Clone, Debug, PartialEq)]
pub struct Assumptions {
    /// How people speak.
    pub params: Params,
    /// Which words are misheard for one another.
    pub confusion: Confusion,
    /// What actions cost.
    pub costs: Costs,
    /// What each question costs, where that was measured.
    pub durations: Option<Durations>,
    /// What the robot may do.
    pub actions: Actions,
    /// What is believed before anything is said.
    pub prior: Prior,
    /// How people point, and from where (metres, frame `base`); none where gestures do not count.
    pub gestures: Option<(Gestures, [f64; 3])>,
}

/// What turns causes into states.
pub struct Mind {
    scene: Scene,
    model: Model,
    costs: Costs,
    durations: Option<Durations>,
    actions: Actions,
    pointing: Option<Pointing>,
    prior: Prior,
    planner: Box<dyn Planner + Send>,
    turns: TurnTaking,
    key: u64,
}

impl Mind {
    /// A mind for one scene and one decision problem; `key` is the identity of both.
    pub fn new(
        scene: Scene,
        assumptions: Assumptions,
        planner: Box<dyn Planner + Send>,
        turns: TurnTaking,
        key: u64,
    ) -> Self {
        let Assumptions { params, confusion, costs, durations, actions, prior, gestures } =
            assumptions;
        let model = Model::new(&scene, params).with_confusion(confusion);
        let model = if prior.absent > 0.0 { model.with_absent() } else { model };
        let pointing = gestures.map(|(model, person)| Pointing::new(model, person, &scene));
        Self { scene, model, costs, durations, actions, pointing, prior, planner, turns, key }
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The name of the planner that decides.
    pub fn planner(&self) -> &'static str {
        self.planner.name()
    }

    /// How turns are taken.
    pub fn turns(&self) -> TurnTaking {
        self.turns
    }

    /// Identity of everything that the mind decides by: settings and scene.
    pub fn key(&self) -> u64 {
        self.key
    }

    /// The state before anything was said.
    pub fn first(&self) -> State {
        let (scene_key, settings_key) = (self.scene.key(), self.key);
        State { scene_key, settings_key, ..State::default() }
    }

    /// The state after `cause`, decided at time `at`.
    pub fn step(&mut self, state: &State, cause: &Cause, at: Time) -> State {
        let mut next = state.clone();
        match cause {
            Cause::Snapshot => {}
            Cause::Utterance(heard) => self.hear(&mut next, heard, at),
            Cause::Silence => self.bear_silence(&mut next, at),
            Cause::Quiet => self.decide_held(&mut next, at),
            Cause::PickEnded { pick, outcome } => self.end_pick(&mut next, *pick, *outcome, at),
            Cause::Reconfigured => self.look_anew(&mut next, at),
        }
        next
    }

    /// Lets the planner decide on the belief as it is now.
    fn decide(
        &mut self,
        state: &mut State,
        heard: PromptId,
        preface: &str,
        utterance: UtteranceSeq,
        at: Time,
    ) {
        let Some(open) = &mut state.open else { return };
        let belief = open.belief();
        let step = Step { interaction: open.id.0, step: open.step };
        open.step += 1;
        let Self { model, costs, durations, actions, planner, .. } = self;
        let durations = durations.as_ref();
        let problem = DecisionProblem { model, costs: *costs, actions: *actions, durations };
        let decision = posterior::of(open).decide(&mut **planner, &problem, step);
        let exhausted = open.presentations >= self.turns.questions_max;
        let action = match decision.action {
            Action::Ask(_) if exhausted => Action::Pick(belief.most_likely()),
            action => action,
        };
        let reasons = Act {
            utterance,
            decided: at,
            value: decision.value,
            expected_questions: decision.expected_questions,
            bounds: decision.bounds,
            alternatives: decision
                .alternatives
                .iter()
                .take(5)
                .map(|(action, value)| (words::action(&self.scene, *action), *value))
                .collect(),
            ..Act::default()
        };
        match action {
            Action::Wait => set(state, reasons),
            Action::Ask(question) => ask(&self.scene, state, question, heard, preface, reasons),
            Action::Pick(object) if self.model.absent() == Some(object) => {
                self.conclude_absent(state, reasons, at);
            }
            Action::Pick(object) => pick(&self.scene, state, object, reasons),
        }
    }

    fn bear_silence(&self, state: &mut State, at: Time) {
        if state.open.is_some() {
            self.see_answer(state, false);
        }
        let Some(open) = &mut state.open else { return };
        open.silences += 1;
        let out_of_questions = open.presentations >= self.turns.questions_max;
        if open.silences > self.turns.repeats_max || out_of_questions {
            self.close(state, Outcome::Abandoned, at, "I will wait until you ask me again.");
        } else {
            repeat(state, at);
        }
    }

    fn end_pick(&mut self, state: &mut State, pick: PickId, outcome: PickOutcome, at: Time) {
        let ordered = state.open.as_ref().and_then(|open| open.pick);
        let Some((id, object)) = ordered else { return };
        let Some(outcome_here) = Outcome::of_pick(outcome) else { return };
        if id != pick {
            return;
        }
        if outcome == PickOutcome::Cancelled {
            // Nobody gave the order up: the arm did, before it had grasped, because it was restarted
            // with another scene.
            if state.act.kind == ActKind::Pick {
                return order_again(state, at);
            }
            if state.open.as_ref().is_some_and(|open| open.corrected) {
                return self.choose_another(state, at);
            }
        }
        if outcome == PickOutcome::Delivered
            && let Some(open) = &state.open
        {
            state.history.count(&open.picked);
        }
        let text = words::ended(&self.scene, object, outcome);
        self.close(state, outcome_here, at, &text);
    }

    /// Ends the interaction without a pick, and says what there is to choose from.
    fn conclude_absent(&self, state: &mut State, reasons: Act, at: Time) {
        self.close(state, Outcome::NotHere, at, &words::not_here(&self.scene));
        let said = state.act.clone();
        state.act = Act { id: said.id, ..keep_words(reasons, &said) };
    }

    fn close(&self, state: &mut State, outcome: Outcome, at: Time, text: &str) {
        let Some(open) = state.open.take() else { return };
        if let Some(joint) = &open.joint {
            state.person = Some(joint.person().clone());
        }
        state.ended = Some(Ended {
            interaction: open.id,
            object: open.pick.map(|(_, object)| object),
            name: open.pick.map(|_| open.picked.clone()),
            outcome,
            questions: questions(&open),
            seconds: at.since(open.opened).s(),
            utterances: open.utterances,
        });
        say(state, text, at);
    }
}

/// Questions asked, each counted once however often it was repeated.
pub fn questions(open: &Interaction) -> u32 {
    open.prompts.len() as u32
}
