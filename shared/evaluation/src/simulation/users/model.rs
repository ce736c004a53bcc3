//! People as the observation model has them: the study against [`dialogue::evaluate`].

use dialogue::{Rng, SimulatedUser};
use scene::{ObjectId, Question};

use super::{Said, Turn, User};
use crate::simulation::interaction::Room;

/// Somebody who answers with the probabilities of eq. (6) and (7), asks for "the bowl", and says
/// nothing unasked.
pub(super) struct Model<'a> {
    model: &'a dialogue::Model,
    user: SimulatedUser,
}

impl<'a> Model<'a> {
    pub(super) fn new(room: &Room<'a>, wanted: ObjectId, mut rng: Rng) -> Self {
        Self { model: room.problem.model, user: SimulatedUser::new(wanted, rng.next_u64()) }
    }
}

impl User for Model<'_> {
    fn wanted(&self) -> ObjectId {
        self.user.wanted()
    }

    fn request(&mut self) -> Turn {
        Turn::SILENCE
    }

    fn answer(&mut self, question: Question) -> Turn {
        match self.user.answer(self.model, question) {
            dialogue::Answer::Silence => Turn::SILENCE,
            answer => Turn::now(Said::Answer(answer)),
        }
    }
}
