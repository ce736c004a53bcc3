//! The transition of the dialogue's state: pure, deterministic, and the same in the service, in a
//! check of its journal, and in simulation.

mod acts;
mod ahead;
mod inform;
mod intents;
mod pointing;
mod words;

use crate::state::{Act, Cause, Interaction, State};
use acts::{ask, pick, repeat, say, set};
use dialogue::gesture::Gestures;
use dialogue::{Action, Actions, Costs, DecisionProblem, Model, Params, Planner, Step};
use node::Time;
use pointing::Pointing;
use protocol::{Ended, Outcome, PickId, PickOutcome, PromptId, UtteranceSeq};
use scene::Scene;

/// How turns are taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turns {
    /// Seconds of silence after a question before it is asked again.
    pub response_window_s: f64,
    /// How often a question is repeated into silence before the interaction is given up.
    pub repeats_max: u32,
    /// How often the robot asks in one interaction, repetitions included, before it stops asking.
    pub questions_max: u32,
}

/// What is taken to be true of people, and what is wanted of the robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Assumptions {
    /// How people speak.
    pub params: Params,
    /// What actions cost.
    pub costs: Costs,
    /// What the robot may do.
    pub actions: Actions,
    /// How people point, and from where (metres, frame `base`); none where gestures do not count.
    pub gestures: Option<(Gestures, [f64; 3])>,
}

/// What turns causes into states.
pub struct Mind {
    scene: Scene,
    model: Model,
    costs: Costs,
    actions: Actions,
    pointing: Option<Pointing>,
    planner: Box<dyn Planner + Send>,
    turns: Turns,
}

impl Mind {
    /// A mind for one scene and one decision problem.
    pub fn new(
        scene: Scene,
        assumptions: Assumptions,
        planner: Box<dyn Planner + Send>,
        turns: Turns,
    ) -> Self {
        let Assumptions { params, costs, actions, gestures } = assumptions;
        let model = Model::new(&scene, params);
        let pointing = gestures.map(|(model, person)| Pointing::new(model, person, &scene));
        Self { scene, model, costs, actions, pointing, planner, turns }
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// How turns are taken.
    pub fn turns(&self) -> Turns {
        self.turns
    }

    /// The state before anything was said.
    pub fn first(&self) -> State {
        State { scene_key: self.scene.key(), ..State::default() }
    }

    /// The state after `cause`, decided at time `at`.
    pub fn step(&mut self, state: &State, cause: &Cause, at: Time) -> State {
        let mut next = state.clone();
        match cause {
            Cause::Snapshot => {}
            Cause::Utterance(heard) => self.hear(&mut next, heard, at),
            Cause::Silence => self.bear_silence(&mut next, at),
            Cause::PickEnded { pick, outcome } => self.end_pick(&mut next, *pick, *outcome, at),
            Cause::SceneChanged => {
                let text = "The scene has changed; please ask me again.";
                self.close(&mut next, Outcome::SceneChanged, at, text);
                next.scene_key = self.scene.key();
            }
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
        open.step += 1;
        let belief = open.belief();
        let step = Step { interaction: open.id.0, step: open.step };
        let problem =
            DecisionProblem { model: &self.model, costs: self.costs, actions: self.actions };
        let decision = self.planner.decide(&problem, &belief, step);
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
            Action::Pick(object) => pick(&self.scene, state, object, reasons),
        }
    }

    fn bear_silence(&self, state: &mut State, at: Time) {
        let Some(open) = &mut state.open else { return };
        open.silences += 1;
        let out_of_questions = open.presentations >= self.turns.questions_max;
        if open.silences > self.turns.repeats_max || out_of_questions {
            self.close(state, Outcome::Abandoned, at, "I will wait until you ask me again.");
        } else {
            repeat(state, at);
        }
    }

    fn end_pick(&self, state: &mut State, pick: PickId, outcome: PickOutcome, at: Time) {
        let ordered = state.open.as_ref().and_then(|open| open.pick);
        let Some((id, object)) = ordered else { return };
        let Some(outcome_here) = Outcome::of_pick(outcome) else { return };
        if id == pick {
            let text = words::ended(&self.scene, object, outcome);
            self.close(state, outcome_here, at, &text);
        }
    }

    fn close(&self, state: &mut State, outcome: Outcome, at: Time, text: &str) {
        let Some(open) = state.open.take() else { return };
        state.ended = Some(Ended {
            interaction: open.id.0,
            object: open.pick.map(|(_, object)| object.0),
            outcome,
            questions: questions(&open),
            seconds: at.since(open.opened).s(),
            utterances: (open.utterances.0.0, open.utterances.1.0),
        });
        say(state, text, at);
    }
}

/// Questions asked, each counted once however often it was repeated.
pub fn questions(open: &Interaction) -> u32 {
    open.prompts.len() as u32
}
