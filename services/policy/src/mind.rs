//! The transition of the dialogue's state: pure, deterministic, and the same in the service, in a
//! check of its journal, and in simulation.

mod intents;
mod words;

use crate::state::{Act, Cause, Heard, Interaction, Prompt, State};
use dialogue::{Action, Actions, Belief, Costs, DecisionProblem, Model, Params, Planner, Step};
use node::Time;
use protocol::{
    ActKind, Ended, InteractionId, Outcome, PickId, PickOutcome, PromptId, UtteranceSeq,
};
use scene::{ObjectId, Question, Scene};

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

/// What turns causes into states.
pub struct Mind {
    scene: Scene,
    model: Model,
    costs: Costs,
    actions: Actions,
    planner: Box<dyn Planner + Send>,
    turns: Turns,
}

impl Mind {
    /// A mind for one scene and one decision problem.
    pub fn new(
        scene: Scene,
        params: Params,
        (costs, actions): (Costs, Actions),
        planner: Box<dyn Planner + Send>,
        turns: Turns,
    ) -> Self {
        let model = Model::new(&scene, params);
        Self { scene, model, costs, actions, planner, turns }
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

    /// Scores what was said against the question that was heard, and decides anew.
    fn inform(&mut self, state: &mut State, heard: &Heard, at: Time) {
        if state.open.is_none() {
            if only_answers(heard) {
                return;
            }
            self.open(state, heard);
        }
        let Some(open) = &mut state.open else { return };
        open.utterances.1 = heard.seq;
        open.silences = 0;
        if open.pick.is_some() {
            return;
        }
        // An answer to an earlier question of this interaction still says what it says about that
        // question; one to another interaction's says nothing.
        let asked = open.prompts.iter().find(|prompt| prompt.id == heard.prompt);
        let question = asked.map_or(Question::None, |prompt| prompt.question);
        let hypotheses: Vec<_> =
            heard.readings.iter().map(|(w, reading)| (*w, question, reading.clone())).collect();
        let mut belief = open.belief();
        belief.update_mixture(&self.model, &hypotheses);
        open.belief = belief.log_weights().to_vec();
        let preface = words::unknown(heard);
        self.decide(state, heard.prompt, &preface, heard.seq, at);
    }

    fn open(&self, state: &mut State, heard: &Heard) {
        state.last_interaction = state.last_interaction.next();
        let prior = Belief::uniform(self.scene.objects().len());
        state.open = Some(Interaction {
            id: state.last_interaction,
            opened: heard.accepted,
            belief: prior.log_weights().to_vec(),
            utterances: (heard.seq, heard.seq),
            ..Interaction::default()
        });
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

/// Whether the utterance holds nothing but answers, which mean nothing where nothing was asked.
fn only_answers(heard: &Heard) -> bool {
    heard.readings.iter().all(|(_, reading)| {
        reading.response != scene::Response::None
            && reading.base.is_empty()
            && reading.excluded.is_empty()
    })
}

/// Makes `act` the standing decision.
fn set(state: &mut State, act: Act) {
    state.act = Act { id: state.act.id.next(), ..act };
}

fn ask(
    scene: &Scene,
    state: &mut State,
    question: Question,
    heard: PromptId,
    preface: &str,
    reasons: Act,
) {
    let standing = state.act.clone();
    let Some(open) = &mut state.open else { return };
    let stands = standing.kind == ActKind::Ask
        && standing.question == question
        && open.prompts.last().is_some_and(|prompt| prompt.id == standing.prompt);
    if stands && heard != standing.prompt {
        // It stands already and nobody has heard it to its end yet: saying it again would only
        // interrupt it.
        state.act = Act { id: standing.id, ..keep_words(reasons, &standing) };
        return;
    }
    open.presentations += 1;
    let text = format!("{preface}{}", scene.phrase(question));
    if stands {
        let again =
            Act { presentation: standing.presentation + 1, ..keep_words(reasons, &standing) };
        set(state, Act { text, ..again });
        return;
    }
    state.last_prompt = state.last_prompt.next();
    open.prompts.push(Prompt { id: state.last_prompt, question });
    let prompt = state.last_prompt;
    let kind = ActKind::Ask;
    set(state, Act { kind, prompt, presentation: 1, question, text, ..reasons });
}

/// The new reasons with the standing act's words.
fn keep_words(reasons: Act, standing: &Act) -> Act {
    Act {
        kind: standing.kind,
        prompt: standing.prompt,
        presentation: standing.presentation,
        question: standing.question,
        pick: standing.pick,
        text: standing.text.clone(),
        ..reasons
    }
}

fn pick(scene: &Scene, state: &mut State, object: ObjectId, reasons: Act) {
    let Some(open) = &mut state.open else { return };
    let id = PickId { interaction: InteractionId(open.id.0), attempt: 1 };
    open.pick = Some((id, object));
    state.last_prompt = state.last_prompt.next();
    let prompt = state.last_prompt;
    let text = words::fetching(scene, object);
    let pick = Some((id, object));
    set(state, Act { kind: ActKind::Pick, prompt, presentation: 1, pick, text, ..reasons });
}

fn say(state: &mut State, text: &str, at: Time) {
    state.last_prompt = state.last_prompt.next();
    let prompt = state.last_prompt;
    let (text, utterance) = (text.to_owned(), state.applied);
    let kind = ActKind::Say;
    set(
        state,
        Act { kind, prompt, presentation: 1, text, utterance, decided: at, ..Act::default() },
    );
}

/// Says the standing words once more.
fn repeat(state: &mut State, at: Time) {
    if let Some(open) = &mut state.open {
        open.presentations += 1;
    }
    let presentation = state.act.presentation + 1;
    set(state, Act { presentation, decided: at, utterance: state.applied, ..state.act.clone() });
}
