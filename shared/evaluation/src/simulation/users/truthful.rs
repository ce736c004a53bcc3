//! People without fault: what is left of errors and time is the robot's own.

use dialogue::Answer;
use scene::{ObjectId, Question};

use super::{Turn, User};
use crate::simulation::interaction::Room;

/// Somebody who answers every question, at once, rightly and in one word.
pub(super) struct Truthful<'a> {
    room: Room<'a>,
    wanted: ObjectId,
}

impl<'a> Truthful<'a> {
    pub(super) fn new(room: &Room<'a>, wanted: ObjectId) -> Self {
        Self { room: *room, wanted }
    }
}

impl User for Truthful<'_> {
    fn wanted(&self) -> ObjectId {
        self.wanted
    }

    fn request(&mut self) -> Turn {
        Turn::words(&format!("get me the {}", self.room.scene.noun()))
    }

    fn answer(&mut self, question: Question) -> Turn {
        let answer = Answer::truthful(self.room.problem.model, question, self.wanted);
        Turn::words(answer.text(self.room.scene))
    }
}
