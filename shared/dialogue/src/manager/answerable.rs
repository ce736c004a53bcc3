//! The question as which the robot's line can be answered.

use scene::Question;
use vocabulary::ActKind;

use super::{Manager, State};

impl Manager {
    /// Returns the question that waits for an answer: that of the act, or whether what was decided while
    /// the motion stop was latched, or is offered instead of something else, shall start.
    pub fn asked(&self, state: &State) -> Question {
        let act = &state.act;
        let confirmable = || {
            let decided = state.confirmable(act.prompt).or_else(|| state.goes_back(act.prompt));
            decided.or_else(|| self.offered(state))
        };
        let confirmable = (act.kind == ActKind::Say).then(confirmable).flatten();
        confirmable.map_or(act.question, Question::Point)
    }

    /// Returns the question as which the act's line can be answered: "I will get the white bowl" can be
    /// denied like "this one?", also after the hand-over.
    pub fn answerable(&self, state: &State) -> Question {
        let act = &state.act;
        let deniable = match (act.kind, act.pick) {
            (ActKind::Pick | ActKind::PutBack, Some((_, object))) => Some(object),
            (ActKind::Say, _) => self.offered(state).or_else(|| state.refusable(act.prompt)),
            _ => None,
        };
        deniable.map_or_else(|| self.asked(state), Question::Point)
    }
}
