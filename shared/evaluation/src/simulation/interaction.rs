//! One interaction, from the request to the hand-over, as the policy's service conducts it.

use dialogue::{Action, Costs, DecisionProblem, Posterior, Rng};
use language::Reader;
use preflight::{Motions, Pace, Voice};
use scene::{Intent, ObjectId, Question, Reading, Response, Scene};

use crate::simulation::users::{Domain, Reply, SimulatedUser, Turn};
use crate::simulation::{Choice, Memo};

/// Everything about a study but policy and people.
#[derive(Clone, Copy, Debug)]
pub struct Room<'a> {
    /// The objects.
    pub scene: &'a Scene,
    /// Reads what people say about them.
    pub reader: &'a Reader,
    /// What is decided, and at what cost.
    pub problem: DecisionProblem<'a>,
    /// When the robot gives up.
    pub patience: Patience,
    /// How fast the robot speaks.
    pub voice: Voice,
    /// How fast people speak and the recogniser works.
    pub pace: &'a Pace,
    /// How long the arm takes; none: it takes no time.
    pub motions: Option<&'a Motions>,
    /// Whether people begin with a request; else the robot begins, knowing nothing.
    pub request: bool,
}

impl<'a> Room<'a> {
    /// The objects that users talk about.
    pub fn domain(&self) -> Domain<'a> {
        Domain { scene: self.scene, model: self.problem.model }
    }
}

/// How long the robot goes on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patience {
    /// Seconds after a question in which an answer is waited for.
    pub response_window_s: f64,
    /// How often a question is repeated into silence before the interaction is given up.
    pub repeats_max: u32,
    /// Questions, repetitions included, after which the robot picks what is most likely.
    pub questions_max: u32,
}

impl Default for Patience {
    /// As in the configuration that comes with the program.
    fn default() -> Self {
        Self { response_window_s: 15.0, repeats_max: 3, questions_max: 20 }
    }
}

/// How an interaction ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The wanted object was handed over.
    Right,
    /// Another one was.
    Wrong,
    /// The policy waits, and nothing will happen any more.
    Waited,
    /// Nobody answered, however often the robot asked.
    Abandoned,
    /// The robot understood that nothing is wanted any more.
    Cancelled,
}

/// What came of an interaction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// How it ended.
    pub end: End,
    /// Questions asked, repetitions included.
    pub questions: u32,
    /// Seconds from the request understood to the decision to pick, or to the end without one.
    pub talk_s: f64,
    /// Seconds to the hand-over, or to the end without one.
    pub seconds: f64,
    /// Discounted return: costs of the actions and worth of the pick, discounted per action. An
    /// interaction that ends without a pick ends with the worth of waiting for ever.
    pub value: f64,
    /// Answers that counted.
    pub answers: u32,
    /// … for another question than the one that was answered.
    pub misplaced: u32,
}

/// Conducts one interaction. `clock` draws durations alone.
pub fn interact(
    room: &Room<'_>,
    memo: &mut Memo<'_>,
    user: &mut SimulatedUser,
    clock: &mut Rng,
) -> Outcome {
    let request = user.request(room.domain());
    let mut talk = Talk::new(room, memo.beginning(&room.problem), clock);
    if room.request && matches!(request.reply, Reply::Words(_)) {
        talk.hear(&request.reply, Question::None);
    }
    loop {
        let end = match talk.decide(memo).action {
            Action::Pick(object) => return talk.pick(object, user.wanted()),
            Action::Wait => talk.wait(user),
            Action::Ask(_) if talk.questions >= room.patience.questions_max => {
                let likeliest = talk.posterior.belief().most_likely();
                return talk.pick(likeliest, user.wanted());
            }
            Action::Ask(question) => talk.ask(question, user),
        };
        if let Some(end) = end {
            return talk.end(end, None);
        }
    }
}

/// What an utterance asks for.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Next {
    /// To decide anew.
    Decide,
    /// To ask the same once more.
    Repeat,
    /// Nothing: it was not meant for the robot.
    Nothing,
    /// To leave it.
    Cancel,
}

/// An interaction in progress.
struct Talk<'r, 'a> {
    room: &'r Room<'a>,
    clock: &'r mut Rng,
    beginning: Posterior,
    posterior: Posterior,
    aimed: Option<ObjectId>,
    step: u32,
    questions: u32,
    answers: u32,
    seconds: f64,
    value: f64,
    discount: f64,
}

impl<'r, 'a> Talk<'r, 'a> {
    fn new(room: &'r Room<'a>, beginning: Posterior, clock: &'r mut Rng) -> Self {
        Self {
            room,
            clock,
            posterior: beginning.clone(),
            beginning,
            aimed: None,
            step: 0,
            questions: 0,
            answers: 0,
            seconds: 0.0,
            value: 0.0,
            discount: 1.0,
        }
    }

    fn costs(&self) -> Costs {
        self.room.problem.costs
    }

    fn decide(&mut self, memo: &mut Memo<'_>) -> Choice {
        let choice = memo.choose(&self.room.problem, &self.posterior, self.step);
        self.step += 1;
        choice
    }

    /// Pays for an action.
    fn pay(&mut self, action: Action) {
        self.value -= self.discount * self.room.problem.cost(action);
        self.discount *= self.costs().discount;
    }

    /// Asks until something is said that counts.
    fn ask(&mut self, question: Question, user: &mut SimulatedUser) -> Option<End> {
        let patience = self.room.patience;
        let mut silences = 0;
        loop {
            self.present(question);
            let turn = user.answer(self.room.domain(), question);
            let next = self.listen(&turn, question);
            self.posterior.see_answer(next != Next::Nothing);
            match next {
                Next::Decide => return None,
                Next::Cancel => return Some(End::Cancelled),
                Next::Repeat => silences = 0,
                Next::Nothing => silences += 1,
            }
            if silences > patience.repeats_max || self.questions >= patience.questions_max {
                return (silences > 0).then_some(End::Abandoned);
            }
        }
    }

    /// Says the question, with the arm aiming where it points.
    fn present(&mut self, question: Question) {
        self.pay(Action::Ask(question));
        self.questions += 1;
        let aimed = match question {
            Question::Point(object) => Some(object),
            _ => None,
        };
        if let (Some(object), Some(motions)) = (aimed, self.room.motions) {
            self.seconds += motions.point_s(self.aimed, object).unwrap_or(0.0);
        }
        self.aimed = aimed;
        self.seconds += self.room.voice.seconds(&self.room.scene.phrase(question));
    }

    /// Waits for the answer and takes it in. One that comes after the window is spoken into the
    /// repeated question, and the person answers that one instead.
    fn listen(&mut self, turn: &Turn, question: Question) -> Next {
        let window_s = self.room.patience.response_window_s;
        let reaction_s = self.room.pace.reaction_s(self.clock) + turn.late_s;
        if turn.reply == Reply::Silence || reaction_s > window_s {
            self.seconds += window_s;
            return Next::Nothing;
        }
        let speech_s = self.room.pace.speech_s(self.clock, turn.reply.words());
        let recogniser_s = self.room.pace.recogniser_s(self.clock);
        let next = self.hear(&turn.reply, question);
        let heard_s = reaction_s + speech_s + recogniser_s;
        self.seconds += if next == Next::Nothing { window_s.max(heard_s) } else { heard_s };
        next
    }

    /// A turn without a question. Where nobody says anything the robot would wait for ever.
    fn wait(&mut self, user: &mut SimulatedUser) -> Option<End> {
        let turn = user.answer(self.room.domain(), Question::None);
        let window_s = self.room.patience.response_window_s;
        if turn.reply == Reply::Silence || self.step > self.room.patience.questions_max {
            self.seconds += window_s;
            return Some(End::Waited);
        }
        self.pay(Action::Wait);
        match self.listen(&turn, Question::None) {
            Next::Cancel => Some(End::Cancelled),
            _ => None,
        }
    }

    /// Updates the belief with what was said, as the policy's service does it.
    fn hear(&mut self, said: &Reply, question: Question) -> Next {
        let model = self.room.problem.model;
        let hypotheses: Vec<(f64, Question, Reading)> = match said {
            Reply::Silence => return Next::Nothing,
            Reply::Answer(answer) => {
                self.answers += 1;
                let heard = [(1.0, question, answer.reading(model))];
                self.posterior.update_mixture(model, &heard);
                return Next::Decide;
            }
            Reply::Words(words) => words
                .iter()
                .map(|(text, weight)| (*weight, question, self.room.reader.read(text, question)))
                .collect(),
        };
        let likeliest = hypotheses.iter().max_by(|a, b| a.0.total_cmp(&b.0));
        match likeliest.map_or(Intent::None, |(.., reading)| reading.intent) {
            Intent::Inform => {
                self.answers += u32::from(likeliest.is_some_and(|(.., r)| says_something(r)));
                self.posterior.update_mixture(model, &hypotheses);
                Next::Decide
            }
            Intent::StartOver => {
                self.posterior = self.beginning.clone();
                Next::Decide
            }
            Intent::Repeat | Intent::AskBack | Intent::Stop => Next::Repeat,
            Intent::None => Next::Nothing,
            Intent::Cancel => Next::Cancel,
        }
    }

    fn pick(self, object: ObjectId, wanted: Option<ObjectId>) -> Outcome {
        let end = if Some(object) == wanted { End::Right } else { End::Wrong };
        self.end(end, Some(object))
    }

    fn end(mut self, end: End, picked: Option<ObjectId>) -> Outcome {
        let worth = match end {
            End::Right => self.costs().correct,
            End::Wrong => -self.costs().wrong,
            End::Waited | End::Abandoned | End::Cancelled => self.costs().wait_value(),
        };
        self.value += self.discount * worth;
        let talk_s = self.seconds;
        if let Some(object) = picked {
            self.seconds += self.fetch_s(object);
        }
        Outcome {
            end,
            questions: self.questions,
            talk_s,
            seconds: self.seconds,
            value: self.value,
            answers: self.answers,
            misplaced: 0,
        }
    }

    /// The robot says what it fetches while it sets out.
    fn fetch_s(&self, object: ObjectId) -> f64 {
        let text = format!("I will get the {}.", self.room.scene.describe(object));
        let said_s = self.room.voice.seconds(&text);
        self.room.motions.map_or(said_s, |motions| motions.pick_s(self.aimed, object).max(said_s))
    }
}

fn says_something(reading: &Reading) -> bool {
    reading.response != Response::None || !reading.base.is_empty() || !reading.excluded.is_empty()
}

#[cfg(test)]
mod tests;
