//! Putting back the object handed over: ordered at once, or after the current fetch; while the
//! motion stop is latched, it waits for a yes and the release. The interaction then continues.

use scene::{Intent, ObjectId, Question, Response, WordId};
use serde::{Deserialize, Serialize};
use vocabulary::ids::{InteractionId, PickId, PromptId};
use vocabulary::time::{Span, Time};
use vocabulary::{ActKind, Outcome, PickOutcome};

use super::Manager;
use super::acts::{next_key, say, say_with, set};
use super::attribution::Heard;
use super::line::{Content, Line, Preface, Remark};
use super::state::{Act, Basis, State, push_bounded};
use super::utterance::Utterance;

/// Share of an utterance's readings from which it is plain that it asks to put something back.
const PLAIN: f64 = 0.5;

/// The object that the user was handed last.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct WithUser {
    /// Name of the object.
    pub name: String,
    /// The interaction that ended with the hand-over.
    pub interaction: InteractionId,
    /// When it was handed over, or last spoken of.
    pub at: Time,
}

/// An object that goes back to its place.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct PuttingBack {
    /// The object.
    pub object: ObjectId,
    /// How far that has come.
    pub progress: Progress,
    /// Lines said about it: each can be answered with yes or no.
    pub lines: Vec<PromptId>,
}

/// How far putting back has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Progress {
    /// The object being fetched is handed over first.
    InTurn,
    /// The object waits for the release of the motion stop.
    HeldBack {
        /// Whether the user has confirmed the order.
        is_confirmed: bool,
    },
    /// The arm has the order.
    Ordered(PickId),
}

impl State {
    /// Returns the order that the arm carries out: to fetch an object, or to put one back.
    pub fn ordered(&self) -> Option<(PickId, ObjectId)> {
        self.to_put_back().or_else(|| self.open.as_ref().and_then(|open| open.pick))
    }

    /// Returns the order to put an object back, while the arm has it.
    pub fn to_put_back(&self) -> Option<(PickId, ObjectId)> {
        let it = self.putting_back.as_ref()?;
        match it.progress {
            Progress::Ordered(id) => Some((id, it.object)),
            Progress::InTurn | Progress::HeldBack { .. } => None,
        }
    }

    /// Returns the object that a line was about which goes back to its place: that can be denied,
    /// and confirmed while the motion stop is latched.
    pub fn goes_back(&self, prompt: PromptId) -> Option<ObjectId> {
        let it = self.putting_back.as_ref().filter(|it| it.lines.contains(&prompt))?;
        Some(it.object)
    }

    /// Notes a line about the object that goes back to its place.
    pub(super) fn note_putting_back(&mut self, prompt: PromptId) {
        if let Some(it) = &mut self.putting_back {
            push_bounded(&mut it.lines, prompt);
        }
    }
}

impl Manager {
    /// Forgets the object that the user was handed once it is theirs.
    pub(super) fn expire_with_user(&self, state: &mut State, at: Time) {
        let window = Span::from_s(self.setup.turns.refusal_s);
        let is_idle = state.open.is_none() && state.putting_back.is_none();
        if is_idle && state.with_user.as_ref().is_some_and(|it| at > it.at + window) {
            state.with_user = None;
        }
    }

    /// Returns whether an utterance asks to put back the object handed over: after a hand-over this
    /// is more than a denial.
    pub(super) fn asks_to_put_back(&self, state: &State, utterance: &Utterance) -> bool {
        let for_itself = utterance.interpretations.iter().filter(|it| it.answers.is_none());
        let (mut all, mut asks) = (0.0, 0.0);
        for it in for_itself {
            all += it.weight;
            asks += if it.reading.intent == Intent::PutBack { it.weight } else { 0.0 };
        }
        let can_go_back = state.with_user.is_some() || state.putting_back.is_some();
        (can_go_back || state.kept().is_some()) && asks > PLAIN * all
    }

    /// Processes the wish to have the object put back that was handed over.
    pub(super) fn put_back(&mut self, state: &mut State, utterance: &Utterance, at: Time) {
        if let Some(it) = &state.putting_back {
            return match it.progress {
                Progress::HeldBack { .. } => self.confirm_put_back(state, at),
                Progress::InTurn | Progress::Ordered(..) => {
                    let remark = self.about_putting_back(state);
                    self.reply(state, remark, at);
                }
            };
        }
        if let Some(object) = self.kept(state).filter(|object| self.is_meant(utterance, *object)) {
            return self.leave_kept(state, object, at);
        }
        let is_fetching = state.open.as_ref().is_some_and(|open| open.pick.is_some());
        let Some(with_user) = state.with_user.clone() else {
            // The object being fetched is meant.
            return match is_fetching {
                true => self.cancel(state, at),
                false => self.reply(state, Remark::NothingToPutBack, at),
            };
        };
        let Some(object) = self.setup.scene.object_named(&with_user.name) else { return };
        if !self.is_meant(utterance, object) {
            return self.reply(state, Remark::NothingToPutBack, at);
        }
        refuse(state, &with_user);
        let progress = Progress::InTurn;
        state.putting_back = Some(PuttingBack { object, progress, lines: Vec::new() });
        if is_fetching {
            let remark = self.about_putting_back(state);
            return self.reply(state, remark, at);
        }
        self.put_back_now(state, Preface::None, at);
    }

    /// Returns whether the words of the wish, if any, are true of the object.
    fn is_meant(&self, utterance: &Utterance, object: ObjectId) -> bool {
        let has = |word: &WordId| self.setup.model.has_word(object, *word);
        let mut wishes =
            utterance.interpretations.iter().filter(|it| it.reading.intent == Intent::PutBack);
        wishes.any(|it| it.reading.base.iter().all(has))
    }

    /// Returns the remark about the object that goes back to its place.
    pub(super) fn about_putting_back(&mut self, state: &State) -> Remark {
        let Some(it) = &state.putting_back else { return Remark::NothingToPutBack };
        let description = self.description(it.object);
        let fetched = state.open.as_ref().and_then(|open| open.pick);
        match (it.progress, fetched) {
            (Progress::InTurn, Some((_, fetched))) => {
                Remark::PutBackInTurn(self.description(fetched), description)
            }
            _ => Remark::PuttingBack(description),
        }
    }

    /// Puts the object back whose turn has come with the end of a pick, if the arm is available.
    pub(super) fn put_back_in_turn(
        &mut self,
        state: &mut State,
        (preface, outcome): (Preface, PickOutcome),
        at: Time,
    ) {
        if matches!(outcome, PickOutcome::Interrupted | PickOutcome::Blocked) {
            // A person must look first; the object stays with the user.
            state.putting_back = None;
            return;
        }
        self.put_back_now(state, preface, at);
    }

    /// Puts the object back whose turn it is, or asks whether to, if the motion stop is latched.
    pub(super) fn put_back_now(&mut self, state: &mut State, preface: Preface, at: Time) {
        let Some(object) = state.putting_back.as_ref().map(|it| it.object) else { return };
        let description = self.description(object);
        state.last_prompt = state.last_prompt.next();
        let (prompt, utterance) = (state.last_prompt, state.applied);
        state.note_putting_back(prompt);
        let (kind, pick, progress, content) = if state.stop.motion.is_latched() {
            let held_back = Progress::HeldBack { is_confirmed: false };
            (ActKind::Say, None, held_back, Content::PutBackHeldBack(description))
        } else {
            let id = next_key(state);
            let pick = Some((id, object));
            (ActKind::PutBack, pick, Progress::Ordered(id), Content::PuttingBack(description))
        };
        let line = Line { preface, content };
        let act = Act { kind, prompt, presentation: 1, pick, line, utterance, ..Act::default() };
        set(state, Act { decided: at, ..act });
        if let Some(it) = &mut state.putting_back {
            it.progress = progress;
        }
    }

    /// Returns the answer to a line about the object that goes back to its place, if it is one.
    pub(super) fn put_back_answer(&self, state: &State, heard: &Heard<'_>) -> Option<Response> {
        let it = state.putting_back.as_ref()?;
        let Some((_, Question::Point(asked), reading)) = heard.interpretations.first() else {
            return None;
        };
        let has = |word: &WordId| self.setup.model.has_word(*asked, *word);
        let is_of_it = *asked == it.object && reading.base.iter().all(has);
        let is_answer = match reading.response {
            Response::Yes => matches!(it.progress, Progress::HeldBack { .. }),
            Response::No => true,
            _ => false,
        };
        (is_of_it && is_answer).then_some(reading.response)
    }

    /// The object is to go back: at once, or upon the release of the motion stop.
    pub(super) fn confirm_put_back(&mut self, state: &mut State, at: Time) {
        if !state.stop.motion.is_latched() {
            return self.put_back_now(state, Preface::None, at);
        }
        if let Some(it) = &mut state.putting_back {
            it.progress = Progress::HeldBack { is_confirmed: true };
        }
        say(state, Content::Confirmed, at);
        state.note_putting_back(state.last_prompt);
    }

    /// Keeps the object where it is: with the user, unless the arm already holds it.
    pub(super) fn withdraw_put_back(&mut self, state: &mut State, at: Time) {
        if state.to_put_back().is_none() {
            state.putting_back = None;
            return self.go_on(state, (Preface::Remark(Remark::AllRight), Content::Cancelled), at);
        }
        if state.act.kind == ActKind::PutBack {
            let pick = state.to_put_back();
            say_with(state, ActKind::Cancel, Content::Keeping, at);
            state.act.pick = pick;
            state.note_putting_back(state.last_prompt);
        }
    }

    /// The motion stop was released: returns whether that concerns an object that goes back.
    pub(super) fn release_put_back(&mut self, state: &mut State, at: Time) -> bool {
        let Some(it) = &state.putting_back else { return false };
        match it.progress {
            Progress::InTurn => return false,
            Progress::Ordered(..) => {}
            Progress::HeldBack { is_confirmed: true } => {
                self.put_back_now(state, Preface::None, at);
            }
            Progress::HeldBack { is_confirmed: false } => {
                let description = self.description(it.object);
                say(state, Content::AskToPutBack(description), at);
                state.note_putting_back(state.last_prompt);
            }
        }
        true
    }

    /// The arm has ended the order to put an object back.
    pub(super) fn end_put_back(&mut self, state: &mut State, outcome: PickOutcome, at: Time) {
        let Some(it) = state.putting_back.take() else { return };
        let name = self.setup.scene.object(it.object).name.clone();
        if outcome == PickOutcome::PutBack {
            state.with_user.take_if(|with_user| with_user.name == name);
            self.hand_over_from_table(state, &name, false);
        }
        if let Some(with_user) = &mut state.with_user {
            with_user.at = at;
        }
        let description = self.description(it.object);
        let preface = Preface::PutBackEnded(description.clone(), outcome);
        self.go_on(state, (preface, Content::PutBackEnded(description, outcome)), at);
    }

    /// Continues the interaction that was open before an object was put back, after the preface;
    /// without one, says the content.
    fn go_on(&mut self, state: &mut State, (preface, content): (Preface, Content), at: Time) {
        let Some(open) = &mut state.open else {
            if state.queue.is_empty() {
                return say(state, content, at);
            }
            return self.serve_queue(state, preface, at);
        };
        let deferred = open.deferred.take().map(|deferred| deferred.basis);
        let utterance = open.utterances.1;
        let held_back = open.held_back.clone().filter(|_| deferred.is_none());
        let held_object = held_back.as_ref().and_then(|it| self.setup.scene.object_named(&it.name));
        if let Some(object) = held_object {
            let reasons = Act { utterance, decided: at, ..Act::default() };
            return match held_back.is_some_and(|it| it.is_confirmed()) {
                true => self.pick(state, object, preface, reasons),
                false => self.ask_to_release(state, object, preface, at),
            };
        }
        let basis = deferred.unwrap_or_else(|| Basis { utterance, ..Basis::default() });
        self.decide(state, Basis { preface, ..basis }, at);
    }
}

/// Counts the delivery as refused.
pub(super) fn refuse(state: &mut State, with_user: &WithUser) {
    drop(state.handed_over.take_if(|it| it.interaction.id == with_user.interaction));
    let delivered = |it: &&mut vocabulary::Ended| {
        it.interaction == with_user.interaction && it.outcome == Outcome::Delivered
    };
    if let Some(ended) = state.ended.as_mut().filter(delivered) {
        ended.outcome = Outcome::Refused;
        state.history.discount(&with_user.name);
        state.users.people.take_back(with_user.interaction);
    }
}
