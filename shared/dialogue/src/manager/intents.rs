//! Requests to the robot other than for an object: intents, cancelling, starting over.

use scene::{Intent, Reading, Reference, Response};
use vocabulary::time::Time;
use vocabulary::{ActKind, Interpretation, Outcome};

use super::Manager;
use super::acts::{call_off, say};
use super::attribution::{content, share_of};
use super::concede::Conceded;
use super::line::{Content, Preface, Remark};
use super::put_back::{Progress, PuttingBack};
use super::replies::likeliest;
use super::rules::{INTENTS, first};
use super::state::{Interaction, State};
use super::stop::StopOrder;
use super::turn::Turn;
use super::utterance::Utterance;

impl Manager {
    /// Processes one utterance. It always counts as applied, and a typed one always gets an answer.
    pub(super) fn hear(&mut self, state: &mut State, utterance: &Utterance, at: Time) {
        state.applied = utterance.seq;
        self.expire(state, at);
        let shares = self.attribute(state, utterance);
        let before = state.act.id;
        let intent = self.intent(state, utterance, &shares);
        let turn = Turn { utterance, shares, intent, at };
        if let Some(rule) = first(INTENTS, intent, |applies| applies(self, state, &turn)) {
            self.rule = rule.name;
            (rule.apply)(self, state, turn);
        }
        // The arm's report is on its way.
        let is_stop = matches!(intent, Intent::Stop | Intent::StopAndCancel);
        let is_silent = state.act.id == before && !is_stop && !is_about_to_speak(state);
        if utterance.typed && is_silent {
            let remark = self.status(state);
            self.reply(state, remark, at);
        }
    }

    /// Returns the intent of an utterance in the present state.
    pub(super) fn intent(&self, state: &State, utterance: &Utterance, shares: &[f64]) -> Intent {
        match likeliest_intent(utterance, shares, state.open.is_some()) {
            Intent::Inform if self.asks_to_put_back(state, utterance) => Intent::PutBack,
            Intent::GoOn if !state.stop.motion.is_latched() || is_confirmed(state, utterance) => {
                answered(utterance)
            }
            intent => intent,
        }
    }

    pub(super) fn cancel(&mut self, state: &mut State, at: Time) {
        let is_in_turn = |it: &PuttingBack| it.progress == Progress::InTurn;
        if state.putting_back.as_ref().is_some_and(|it| !is_in_turn(it)) {
            return self.withdraw_put_back(state, at);
        }
        let Some(open) = &mut state.open else { return say(state, Content::Cancelled, at) };
        state.queue.clear();
        // Another object may have been wanted instead of the one being left: no longer.
        open.corrected = false;
        if self.ask_about_kept(state, Preface::Remark(Remark::AllRight), at) {
            return;
        }
        let Some(open) = &state.open else { return };
        if open.pick.is_none() {
            self.close(state, Outcome::Cancelled, at, Content::Cancelled);
        } else if state.act.kind == ActKind::Pick {
            call_off(state, Content::CallingOff, at);
        }
    }

    /// "again!" after a hand-over.
    pub(super) fn asks_for_another(&self, state: &State, utterance: &Utterance) -> bool {
        let is_again = |it: &Interpretation| {
            it.answers.is_none()
                && it.reading.refers == Reference::Same
                && it.reading.base.is_empty()
        };
        let is_over = state.open.is_none() && state.handed_over.is_some();
        is_over && utterance.interpretations.iter().any(is_again)
    }

    /// Forgets the words about the wanted object, and asks for it unless the same utterance names
    /// it.
    pub(super) fn start_over(&mut self, state: &mut State, utterance: &Utterance, at: Time) {
        self.forget(state, at);
        if let Some(request) = request_after(utterance) {
            self.inform(state, Turn::alone(&request, at));
        }
    }

    fn forget(&mut self, state: &mut State, at: Time) {
        let from = state.open.as_ref().map(Interaction::from).unwrap_or_default();
        let beginning = self.beginning(state, &from);
        let is_putting_back = state.to_put_back().is_some();
        match &mut state.open {
            None if is_putting_back => {}
            None => return say(state, Content::Wanted(1), at),
            Some(open) if open.pick.is_some() => return,
            Some(open) => {
                open.silences = 0;
                open.evidence.clear();
                open.prompts.clear();
                open.forgotten = 0;
                open.conceded = Conceded::default();
                open.posterior = beginning;
                open.deferred = None;
                open.held_back.take_if(|it| !it.is_kept());
                state.queue.clear();
            }
        }
        if is_putting_back {
            // It asks once the object is back.
            let remark = self.about_putting_back(state);
            return self.reply(state, remark, at);
        }
        if !self.ask_about_kept(state, Preface::Remark(Remark::AllRight), at) {
            self.ask_wanted(state, at);
        }
    }
}

/// Returns whether an answer comes without a further word of the user: a decision is deferred, or
/// the standing question is on its way.
fn is_about_to_speak(state: &State) -> bool {
    let Some(open) = &state.open else { return false };
    let is_deferred = open.deferred.is_some() && state.to_put_back().is_none();
    is_deferred || state.act.kind == ActKind::Ask
}

/// Notes an order to stop, which the speech service has given to the arm: the robot reports its
/// effect once the arm has.
pub(super) fn order_stop(state: &mut State, utterance: &Utterance) {
    state.stop.order = Some(StopOrder { accepted: utterance.accepted, is_late: false });
}

/// Returns whether an utterance withdraws only the objects that it describes.
pub(super) fn excludes(utterance: &Utterance) -> bool {
    likeliest(utterance, Intent::Cancel).is_some_and(|reading| !reading.excluded.is_empty())
}

/// Returns whether an order to stop also says which object is wanted or not.
pub(super) fn is_about_object(utterance: &Utterance) -> bool {
    likeliest(utterance, Intent::Stop).is_some_and(|it| *content(it) != Reading::default())
}

/// Returns whether "ok, go on" confirms a pick that waits for the release of the motion stop.
fn is_confirmed(state: &State, utterance: &Utterance) -> bool {
    let is_fetched = state.open.as_ref().is_some_and(|open| open.held_back.is_some());
    let held_back = |it: &PuttingBack| matches!(it.progress, Progress::HeldBack { .. });
    let is_put_back = state.putting_back.as_ref().is_some_and(held_back);
    let yes = |it: &Reading| it.response == Response::Yes;
    (is_fetched || is_put_back) && likeliest(utterance, Intent::GoOn).is_some_and(yes)
}

/// Returns the intent of "go on" as an answer.
fn answered(utterance: &Utterance) -> Intent {
    let answers = |it: &Interpretation| {
        it.reading.intent == Intent::GoOn && it.reading.response != Response::None
    };
    if utterance.interpretations.iter().any(answers) { Intent::Inform } else { Intent::None }
}

/// Returns the request that comes with starting over: "start over, I want the ladle".
fn request_after(utterance: &Utterance) -> Option<Utterance> {
    let asks = |it: &&Interpretation| {
        it.answers.is_none()
            && it.reading.intent == Intent::StartOver
            && !it.reading.base.is_empty()
    };
    let asked = utterance.interpretations.iter().find(asks)?;
    let reading = Reading { intent: Intent::Inform, ..asked.reading.clone() };
    let interpretations = vec![Interpretation { reading, ..asked.clone() }];
    Some(Utterance { interpretations, ..utterance.clone() })
}

/// Returns the most probable intent, over all interpretations. If nothing is open, "thank you, that
/// is perfect" is thanks rather than an answer.
fn likeliest_intent(utterance: &Utterance, shares: &[f64], is_open: bool) -> Intent {
    let mut alone = utterance.interpretations.iter().filter(|it| it.answers.is_none());
    if let Some(intent @ (Intent::Thank | Intent::Greet | Intent::Leave)) =
        alone.next().map(|it| it.reading.intent).filter(|_| !is_open)
    {
        return intent;
    }
    let mut sums: Vec<(Intent, f64)> = Vec::new();
    for interpretation in &utterance.interpretations {
        let share = interpretation.weight * share_of(interpretation, shares);
        match sums.iter_mut().find(|(intent, _)| *intent == interpretation.reading.intent) {
            Some((_, sum)) => *sum += share,
            None => sums.push((interpretation.reading.intent, share)),
        }
    }
    let likeliest = sums.into_iter().reduce(|best, next| if next.1 > best.1 { next } else { best });
    likeliest.map_or(Intent::None, |(intent, _)| intent)
}
