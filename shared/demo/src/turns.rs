//! What time brings about: ends of lines, silence, the arm's progress.

use dialogue::manager::{Cause, Floor, MotionStop};
use vocabulary::time::{Span, Time};
use vocabulary::{PickOutcome, PickPhase};

use crate::Session;

/// Time between two looks.
const STEP: Span = Span::from_ms(20);
/// Longest time of one call. A page that was hidden for longer finds the robot as it left it.
const LONGEST: Span = Span::from_ms(60_000);

impl Session {
    /// Lets time pass.
    pub fn advance(&mut self, span: Span) {
        let until = self.now + span.min(LONGEST);
        while self.now < until {
            let next = (self.now + STEP).min(until);
            self.arm.advance(next.since(self.now).s());
            self.now = next;
            self.voice.advance(next);
            self.watch_arm();
            self.take_turns();
        }
    }

    /// Takes over how far the arm has come: the motion stop, and the end of an order.
    pub(crate) fn watch_arm(&mut self) {
        let stop = self.arm.motion_stop();
        let before = self.state.stop.motion;
        if stop != before {
            self.apply(&Cause::MotionStop(stop));
        }
        if stop.is_latched() != before.is_latched() {
            self.transcript.motion_stop(stop.is_latched(), self.now);
        }
        self.report_stop();
        let Some((pick, _)) = self.state.ordered() else { return };
        let done = self.arm.order().filter(|it| it.id == pick && it.phase == PickPhase::Done);
        let outcome = done.map_or(PickOutcome::Pending, |order| order.outcome);
        if outcome != PickOutcome::Pending {
            self.apply(&Cause::PickEnded { pick, outcome });
        }
    }

    /// Reports the effect of a stop that a user ordered in words, once the arm is at rest.
    pub(crate) fn report_stop(&mut self) {
        let is_at_rest = self.arm.motion_stop() == MotionStop::Stopped;
        if is_at_rest && self.state.stop.order.is_some() {
            self.apply(&Cause::StopReport { confirmed: true });
        }
    }

    fn take_turns(&mut self) {
        let floor = self.floor();
        if self.manager.quiet_is_due(&self.state, &floor, self.now) {
            self.apply(&Cause::Quiet);
        }
        if self.manager.silence_is_due(&self.state, &self.floor(), self.now) {
            self.apply(&Cause::Silence);
        }
    }

    /// Returns the state of both voices. Typed words are heard at once.
    fn floor(&self) -> Floor {
        let presented = self.voice.presented();
        let ended: Option<Time> = presented.ended.filter(|_| presented.complete);
        let listened = ended.map_or(Span(0), |ended| self.now.since(ended));
        Floor { presented, listened, ..Floor::default() }
    }
}
