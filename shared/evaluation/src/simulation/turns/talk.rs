//! A dialogue in real time: the user's speech, the robot's voice and the clock. The dialogue itself
//! is conducted by the dialogue manager.

use dialogue::manager::{Cause, Floor, Manager, State, Utterance};
use scene::Question;
use vocabulary::reaction::Reaction;
use vocabulary::time::{Span, Time};
use vocabulary::{ActKind, Action, Attribution, Interpretation, Presentation, Rng, TurnTaking};

use super::rules::Rules;
use crate::simulation::interaction::SimulatedInteraction;
use crate::simulation::room::Room;
use crate::simulation::users::{Reply, TimedKind, TimedUser, TimedUtterance};
use user_study::Verdict;

/// Duration of a spoken question: median, seconds, and standard deviation of the logarithm. It is
/// the web interface's voice and its delay, not the arm's own voice.
const QUESTION_S: (f64, f64) = (1.9, 0.12);
/// Presentations that an utterance carries.
const PRESENTATIONS_MAX: usize = 4;

/// Plays one dialogue with `manager`, which takes on these rules.
pub(super) fn talk(
    room: &Room<'_>,
    manager: &mut Manager,
    rules: &Rules,
    kind: &TimedKind,
    rng: Rng,
) -> SimulatedInteraction {
    let mut user = kind.user(room.domain(), room.pace, rules.open, rng);
    let (median_s, log_sd) = room.pace.reaction_s;
    // With push-to-talk users wait for the click before they speak.
    let click_s = if rules.open { 0.0 } else { kind.click_s };
    manager.set_turns(TurnTaking {
        response_window_s: rules.window_s,
        repeats_max: u32::MAX,
        attribution: rules.attribution,
        defers: rules.hold,
        repeats_same: rules.same,
        spoken: Reaction::new(median_s + click_s, log_sd),
        ..room.turns
    });
    let now_s = user.request_s(room.domain());
    let state = manager.first();
    let mut talk = Talk {
        room,
        rules,
        manager,
        state,
        user,
        now_s,
        put: Vec::new(),
        heard: 0,
        misplaced: 0,
        value: 0.0,
        discount: 1.0,
    };
    let request = Interpretation { weight: 1.0, ..Interpretation::default() };
    talk.publish(now_s, now_s, vec![], vec![request]);
    talk.run()
}

struct Talk<'a> {
    room: &'a Room<'a>,
    rules: &'a Rules,
    manager: &'a mut Manager,
    state: State,
    user: TimedUser,
    now_s: f64,
    /// Presentations, oldest first.
    put: Vec<Presentation>,
    heard: u32,
    misplaced: u32,
    value: f64,
    discount: f64,
}

impl Talk<'_> {
    fn run(mut self) -> SimulatedInteraction {
        loop {
            if !self.plan() {
                continue;
            }
            match (self.state.act.kind, self.state.act.pick) {
                (ActKind::Pick, Some((_, object))) => {
                    let right = Some(object) == self.user.user().wanted();
                    return self.end(if right { Verdict::Right } else { Verdict::Wrong });
                }
                (ActKind::Ask, _) => {
                    self.ask(self.state.act.question);
                    self.listen();
                }
                _ => return self.end(Verdict::Abandoned),
            }
        }
    }

    /// Spends the time that planning takes; returns whether its decision is still valid. A naive
    /// robot does not listen meanwhile.
    fn plan(&mut self) -> bool {
        let planned = self.state.act.id;
        let done_s = self.now_s + self.rules.planner_s;
        if self.rules.hold || self.rules.attribution != Attribution::Naive {
            self.take_in(done_s);
        }
        self.now_s = self.now_s.max(done_s);
        if self.rules.hold {
            self.wait_for_the_user();
        }
        self.state.act.id == planned
    }

    /// Listens until the user has finished speaking, and makes the deferred decision.
    fn wait_for_the_user(&mut self) {
        while let Some(until_s) = self.user.busy_until_s(self.now_s) {
            self.take_in(until_s);
            self.now_s = until_s;
        }
        if self.is_deferred() {
            self.step(&Cause::Quiet);
        }
    }

    fn is_deferred(&self) -> bool {
        self.state.open.as_ref().is_some_and(|open| open.deferred.is_some())
    }

    fn step(&mut self, cause: &Cause) {
        self.manager.step(&mut self.state, cause, time(self.now_s));
    }

    /// Says the standing question.
    fn ask(&mut self, question: Question) {
        self.value -= self.discount * self.room.problem.cost(Action::Ask(question));
        self.discount *= self.room.problem.costs.discount;
        let began = time(self.now_s);
        self.now_s += self.user.user_mut().rng().log_normal(QUESTION_S.0, QUESTION_S.1);
        self.put.push(Presentation {
            prompt: self.state.act.prompt,
            number: self.state.act.presentation,
            question,
            scene: self.state.scene_key,
            began,
            ended: Some(time(self.now_s)),
            complete: true,
        });
        let asked = (self.put.len() as u64 - 1, question);
        self.user.question_ended(self.room.domain(), asked, self.now_s);
    }

    /// Listens until the decision changes or the response window has passed.
    fn listen(&mut self) {
        let standing = self.state.act.id;
        // Utterances that arrived while the robot spoke end its listening at once.
        self.take_in(self.now_s);
        let mut until_s = self.now_s + self.manager.response_window_s(&self.state);
        while self.state.act.id == standing && !self.is_deferred() {
            if let Some(utterance) = self.user.result(until_s) {
                self.now_s = self.now_s.max(utterance.result_s);
                self.hear(&utterance);
                continue;
            }
            self.now_s = until_s;
            match self.user.busy_until_s(self.now_s) {
                Some(busy_s) if self.rules.hold => until_s = busy_s,
                _ => return self.step(&Cause::Silence),
            }
        }
        if self.is_deferred() {
            self.wait_for_the_user();
        }
    }

    /// Processes arrivals until the given time.
    fn take_in(&mut self, until_s: f64) {
        while let Some(utterance) = self.user.result(until_s) {
            self.now_s = self.now_s.max(utterance.result_s);
            self.hear(&utterance);
        }
    }

    /// Passes on an answer, and notes whether it was attributed to another question.
    fn hear(&mut self, utterance: &TimedUtterance) {
        let Reply::Answer(answer) = utterance.reply else { return };
        let reading = answer.reading(self.room.problem.model);
        let presentations: Vec<Presentation> =
            self.put.iter().rev().take(PRESENTATIONS_MAX).copied().collect();
        let places = (0..presentations.len()).map(Some).chain([None]);
        let interpretations = places
            .map(|answers| Interpretation { weight: 1.0, answers, reading: reading.clone() })
            .collect();
        self.publish(utterance.onset_s, utterance.end_s, presentations, interpretations);
        self.heard += 1;
        let attributed = &self.state.attributed;
        let best = attributed.questions.iter().max_by(|a, b| a.share.total_cmp(&b.share));
        let best = best.filter(|best| best.share >= attributed.none);
        let put = best.and_then(|best| self.put.iter().find(|put| put.prompt == best.prompt));
        self.misplaced += u32::from(put.is_none_or(|put| put.question != utterance.question));
    }

    fn publish(
        &mut self,
        onset_s: f64,
        end_s: f64,
        presentations: Vec<Presentation>,
        interpretations: Vec<Interpretation>,
    ) {
        let busy = self.user.busy_until_s(self.now_s).is_some();
        let floor = Floor { pending: if busy { 2 } else { 0 }, ..Floor::default() };
        let utterance = Utterance {
            seq: self.state.applied.next(),
            presentations,
            onset: time(onset_s),
            end: time(end_s),
            accepted: time(self.now_s),
            interpretations,
            more: self.manager.more_is_coming(&floor, time(self.now_s)),
            ..Utterance::default()
        };
        self.step(&Cause::Utterance(utterance));
    }

    fn end(mut self, verdict: Verdict) -> SimulatedInteraction {
        self.value += self.discount * verdict.worth(&self.room.problem.costs);
        SimulatedInteraction {
            verdict,
            questions: self.put.len() as u32,
            denied: 0,
            talk_s: self.now_s,
            seconds: self.now_s,
            value: self.value,
            answers: self.heard,
            misplaced: self.misplaced,
            stated: None,
        }
    }
}

fn time(seconds: f64) -> Time {
    Time(0) + Span::from_s(seconds)
}
