//! One interaction in turns, from the request to the hand-over: the user's replies, the clock and
//! the costs. The dialogue itself is conducted by the dialogue manager.

use dialogue::manager::{Cause, Manager, State, Utterance};
use dialogue::{Answer, rendering};
use scene::{Intent, ObjectId, Question, Reading, Response};
use vocabulary::time::{Span, Time};
use vocabulary::{ActKind, Action, Interpretation, PersonId, PickOutcome, Presentation, Rng};

use crate::simulation::room::Room;
use crate::simulation::users::{Reply, SimulatedUser, Turn};
use user_study::Verdict;

/// A simulated interaction that has ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SimulatedInteraction {
    /// Verdict; one in which the robot waits for ever is abandoned.
    pub verdict: Verdict,
    /// Questions asked, repetitions included.
    pub questions: u32,
    /// Announced picks that were denied in time.
    pub denied: u32,
    /// Seconds from the request understood to the last decision to pick, or to the end without one.
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
    /// Belief about the object when the robot decided to pick it.
    pub stated: Option<f64>,
}

/// Plays one interaction of `user` with `manager`. `clock` draws durations alone.
pub fn interact(
    room: &Room<'_>,
    manager: &mut Manager,
    user: &mut SimulatedUser,
    clock: &mut Rng,
) -> SimulatedInteraction {
    let state = manager.first();
    Play::new(room, manager, clock, (state, Time(0), PersonId::default())).first_pick(user)
}

/// Plays the next interaction with a person, whom the manager knows from `state`. A wrong object is
/// refused until the right one is handed over; the result is about the first one.
pub(super) fn interact_again(
    room: &Room<'_>,
    manager: &mut Manager,
    (state, from): (&mut State, PersonId),
    user: &mut SimulatedUser,
    clock: &mut Rng,
) -> SimulatedInteraction {
    // Long after the last one.
    let begins = state.act.decided + Span::from_s(PAUSE_S);
    let mut play = Play::new(room, manager, clock, (std::mem::take(state), begins, from));
    let ended = play.first_pick(user);
    play.hand_over(user);
    *state = play.state;
    ended
}

/// Time between two interactions of a person.
const PAUSE_S: f64 = 3600.0;
/// Objects that are handed over until the user gives up.
const HAND_OVERS_MAX: u32 = 6;

/// An interaction in progress: user, clock and costs. The dialogue itself is the manager's.
struct Play<'r, 'a> {
    room: &'r Room<'a>,
    manager: &'r mut Manager,
    clock: &'r mut Rng,
    state: State,
    begins: Time,
    from: PersonId,
    aimed: Option<ObjectId>,
    questions: u32,
    denied: u32,
    waits: u32,
    answers: u32,
    seconds: f64,
    value: f64,
    discount: f64,
}

impl<'r, 'a> Play<'r, 'a> {
    fn new(
        room: &'r Room<'a>,
        manager: &'r mut Manager,
        clock: &'r mut Rng,
        (state, begins, from): (State, Time, PersonId),
    ) -> Self {
        Self {
            room,
            manager,
            clock,
            state,
            begins,
            from,
            aimed: None,
            questions: 0,
            denied: 0,
            waits: 0,
            answers: 0,
            seconds: 0.0,
            value: 0.0,
            discount: 1.0,
        }
    }

    /// Plays from the request to the first pick, or to the end without one.
    fn first_pick(&mut self, user: &mut SimulatedUser) -> SimulatedInteraction {
        self.begin(&user.request(self.room.domain()));
        match self.go_on(user) {
            Ok(object) => self.pick(object, user.wanted()),
            Err(verdict) => self.end(verdict, None),
        }
    }

    /// Talks until a pick is decided; returns the verdict without one.
    fn go_on(&mut self, user: &mut SimulatedUser) -> Result<ObjectId, Verdict> {
        loop {
            let question = self.state.act.question;
            let (kind, pick) = (self.state.act.kind, self.state.act.pick);
            let verdict = match (kind, pick) {
                (ActKind::Pick, Some((_, object))) if !self.is_denied(object, user) => {
                    return Ok(object);
                }
                (ActKind::Pick, Some(_)) => None,
                (ActKind::Ask, _) => self.ask(question, user),
                (ActKind::Wait, _) => self.wait(user),
                _ => Some(self.closed()),
            };
            if let Some(verdict) = verdict {
                return Err(verdict);
            }
        }
    }

    /// Hands over picked objects until one is the wanted one. A user who has an object in the hand
    /// does not err.
    fn hand_over(&mut self, user: &mut SimulatedUser) {
        for _ in 0..HAND_OVERS_MAX {
            let (ActKind::Pick, Some((pick, object))) = (self.state.act.kind, self.state.act.pick)
            else {
                return;
            };
            self.step(&Cause::PickEnded { pick, outcome: PickOutcome::Delivered });
            if Some(object) == user.wanted() {
                return;
            }
            let put = self.presentation(Question::Point(object), self.now());
            self.seconds += 1.0;
            self.hear(&Reply::Answer(Answer::No), Some(put), self.seconds, 1.0);
            if self.state.open.is_none() || self.go_on(user).is_err() {
                return;
            }
        }
    }

    /// Returns the presentation of the standing line, as that question, from then until now.
    fn presentation(&self, question: Question, began: Time) -> Presentation {
        Presentation {
            prompt: self.state.act.prompt,
            number: self.state.act.presentation,
            question,
            scene: self.state.scene_key,
            began,
            ended: Some(self.now()),
            complete: true,
        }
    }

    /// Makes the user's request, or a bare one if the user makes none.
    fn begin(&mut self, request: &Turn) {
        let before = self.state.ended.clone();
        if self.room.request && matches!(request.reply, Reply::Words(_)) {
            self.hear(&request.reply, None, 0.0, 0.0);
        }
        if self.state.open.is_none() && self.state.ended == before {
            let utterance = self
                .utterance(None, vec![Interpretation { weight: 1.0, ..Interpretation::default() }]);
            self.step(&Cause::Utterance(utterance));
        }
    }

    fn now(&self) -> Time {
        self.begins + Span::from_s(self.seconds)
    }

    fn step(&mut self, cause: &Cause) {
        let now = self.now();
        self.manager.step(&mut self.state, cause, now);
    }

    /// Pays for an action.
    fn pay(&mut self, action: Action) {
        self.value -= self.discount * self.room.problem.cost(action);
        self.discount *= self.room.problem.costs.discount;
    }

    /// Presents the standing question, with the arm pointing if needed, and waits for its answer.
    fn ask(&mut self, question: Question, user: &mut SimulatedUser) -> Option<Verdict> {
        self.pay(Action::Ask(question));
        self.questions += 1;
        let in_words = self.state.act.is_in_words();
        let aimed = match question {
            Question::Point(object) if !in_words => Some(object),
            _ => None,
        };
        if let (Some(object), Some(motions)) = (aimed, self.room.motions) {
            self.seconds += motions.point_s(self.aimed, object).unwrap_or(0.0);
        }
        self.aimed = aimed;
        let began = self.now();
        self.seconds += match question {
            _ if in_words => self.said_s(),
            question => self.room.voice.seconds(&self.room.scene.phrase(question)),
        };
        let presentation = self.presentation(question, began);
        let turn = user.answer(self.room.domain(), question);
        self.listen(&turn, Some(presentation));
        None
    }

    /// A turn without a question. A silent user would make the robot wait for ever.
    fn wait(&mut self, user: &mut SimulatedUser) -> Option<Verdict> {
        let turn = user.answer(self.room.domain(), Question::None);
        self.waits += 1;
        if turn.reply == Reply::Silence || self.waits > self.manager.turns().questions_max {
            self.seconds += self.manager.response_window_s(&self.state);
            return Some(Verdict::Abandoned);
        }
        self.pay(Action::Wait);
        self.listen(&turn, None);
        None
    }

    /// Waits for the user's reply and passes it on. One that comes after the window is spoken into
    /// the repeated question, and the user answers that one instead.
    fn listen(&mut self, turn: &Turn, presentation: Option<Presentation>) {
        let window_s = self.manager.response_window_s(&self.state);
        let reaction_s = self.room.pace.reaction_s(self.clock) + turn.late_s;
        let began_s = self.seconds;
        if turn.reply != Reply::Silence && reaction_s <= window_s {
            let speech_s = self.room.pace.speech_s(self.clock, turn.reply.words());
            let recogniser_s = self.room.pace.recogniser_s(self.clock);
            let standing = self.state.act.id;
            self.seconds += reaction_s + speech_s + recogniser_s;
            self.hear(&turn.reply, presentation, began_s + reaction_s, speech_s);
            if self.state.act.id != standing {
                return;
            }
        }
        self.seconds = self.seconds.max(began_s + window_s);
        if presentation.is_some() {
            self.step(&Cause::Silence);
        }
    }

    /// Passes on the user's utterance.
    fn hear(
        &mut self,
        reply: &Reply,
        presentation: Option<Presentation>,
        onset_s: f64,
        speech_s: f64,
    ) {
        let answers = presentation.map(|_| 0);
        let question = presentation.map_or(Question::None, |put| put.question);
        let interpretations: Vec<Interpretation> = match reply {
            Reply::Silence => return,
            Reply::Answer(answer) => {
                let reading = answer.reading(self.room.problem.model);
                vec![Interpretation { weight: 1.0, answers, reading }]
            }
            Reply::Words(words) => words
                .iter()
                .map(|(text, weight)| {
                    let reading = self.room.reader.read(text, question);
                    Interpretation { weight: *weight, answers, reading }
                })
                .collect(),
        };
        let likeliest = interpretations.iter().max_by(|a, b| a.weight.total_cmp(&b.weight));
        self.answers += u32::from(likeliest.is_some_and(|it| says_something(&it.reading)));
        let utterance = Utterance {
            onset: self.begins + Span::from_s(onset_s),
            end: self.begins + Span::from_s(onset_s + speech_s),
            ..self.utterance(presentation, interpretations)
        };
        self.step(&Cause::Utterance(utterance));
    }

    fn utterance(
        &self,
        presentation: Option<Presentation>,
        interpretations: Vec<Interpretation>,
    ) -> Utterance {
        Utterance {
            seq: self.state.applied.next(),
            presentations: presentation.into_iter().collect(),
            accepted: self.now(),
            interpretations,
            from: self.from.clone(),
            ..Utterance::default()
        }
    }

    /// Returns the verdict on an interaction that the manager has closed.
    fn closed(&self) -> Verdict {
        let ended = self.state.ended.as_ref();
        ended.and_then(|ended| Verdict::of(ended.outcome, false)).unwrap_or(Verdict::Cancelled)
    }

    /// Announces the pick. If the user denies it and is heard before the object is gripped, the arm
    /// leaves it and returns. A denial that is not understood, or too late, changes nothing.
    fn is_denied(&mut self, object: ObjectId, user: &mut SimulatedUser) -> bool {
        if !self.room.denials {
            return false;
        }
        let announce = self.room.problem.announce;
        let turn = user.objection(self.room.domain(), announce, object);
        if turn.reply == Reply::Silence {
            return false;
        }
        let (announced_s, said_s) = (self.seconds, self.said_s());
        let reaction_s = self.room.pace.reaction_s(self.clock) + turn.late_s;
        let speech_s = self.room.pace.speech_s(self.clock, turn.reply.words());
        let heard_s = said_s + reaction_s + speech_s + self.room.pace.recogniser_s(self.clock);
        let grip_s = self.room.motions.map_or(0.0, |motions| motions.grip_s(self.aimed, object));
        // A user model of mere probabilities denies in time: `heard` accounts for that.
        if heard_s > grip_s && !matches!(turn.reply, Reply::Answer(_)) {
            return false;
        }
        let began = self.now();
        self.seconds += said_s;
        let presentation = self.presentation(Question::Point(object), began);
        let onset_s = self.seconds + reaction_s;
        self.seconds = announced_s + heard_s;
        self.hear(&turn.reply, Some(presentation), onset_s, speech_s);
        let (ActKind::Cancel, Some((pick, _))) = (self.state.act.kind, self.state.act.pick) else {
            self.seconds = announced_s;
            return false;
        };
        self.denied += 1;
        self.seconds += heard_s.min(grip_s);
        self.aimed = None;
        self.value -= self.discount * announce.cost_s;
        self.discount *= self.room.problem.costs.discount;
        self.step(&Cause::PickEnded { pick, outcome: PickOutcome::Cancelled });
        true
    }

    fn pick(&mut self, object: ObjectId, wanted: Option<ObjectId>) -> SimulatedInteraction {
        let verdict = if Some(object) == wanted { Verdict::Right } else { Verdict::Wrong };
        self.end(verdict, Some(object))
    }

    fn end(&mut self, verdict: Verdict, picked: Option<ObjectId>) -> SimulatedInteraction {
        self.value += self.discount * verdict.worth(&self.room.problem.costs);
        let talk_s = self.seconds;
        let open = self.state.open.as_ref();
        let stated = picked.and_then(|object| Some(open?.belief().probability(object)));
        if let Some(object) = picked {
            self.seconds += self.fetch_s(object);
        }
        SimulatedInteraction {
            verdict,
            questions: self.questions,
            denied: self.denied,
            talk_s,
            seconds: self.seconds,
            value: self.value,
            answers: self.answers,
            misplaced: 0,
            stated,
        }
    }

    /// Returns the seconds of a pick. The robot announces the object while it sets out.
    fn fetch_s(&self, object: ObjectId) -> f64 {
        let said_s = self.said_s();
        self.room.motions.map_or(said_s, |motions| motions.pick_s(self.aimed, object).max(said_s))
    }

    /// Returns the seconds that the standing line takes.
    fn said_s(&self) -> f64 {
        self.room.voice.seconds(&rendering::text(self.room.scene, &self.state.act))
    }
}

fn says_something(reading: &Reading) -> bool {
    let says = reading.response != Response::None
        || !reading.base.is_empty()
        || !reading.excluded.is_empty();
    says && reading.intent == Intent::Inform
}

#[cfg(test)]
mod tests;
