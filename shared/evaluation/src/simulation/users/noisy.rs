//! People as recognisers hear them on a bad day.

use dialogue::{Answer, Rng};
use scene::{ObjectId, Question};

use super::recogniser::Recogniser;
use super::wording::{Wording, own_values};
use super::{Turn, User, wrong_answer};
use crate::simulation::draw::{between, chance};
use crate::simulation::interaction::Room;

/// Share of wrong answers, drawn per person.
const EPSILON: (f64, f64) = (0.05, 0.20);
/// Share of questions left unanswered, drawn per person.
const SILENT: (f64, f64) = (0.20, 0.30);
/// How many values the request names, by probability: none, one, two.
const REQUEST: [f64; 3] = [0.5, 0.3, 0.2];

/// Somebody who is often silent, often wrong, and heard badly.
pub(super) struct Noisy<'a> {
    room: Room<'a>,
    wanted: ObjectId,
    rng: Rng,
    epsilon: f64,
    silent: f64,
    recogniser: Recogniser<'a>,
}

impl<'a> Noisy<'a> {
    pub(super) fn new(room: &Room<'a>, wanted: ObjectId, mut rng: Rng) -> Self {
        let epsilon = between(&mut rng, EPSILON);
        let silent = between(&mut rng, SILENT);
        let recogniser = Recogniser::bad(room.scene);
        Self { room: *room, wanted, rng, epsilon, silent, recogniser }
    }
}

impl User for Noisy<'_> {
    fn wanted(&self) -> ObjectId {
        self.wanted
    }

    fn request(&mut self) -> Turn {
        let wording = Wording::plain(self.room.scene);
        let named = own_values(self.room.scene, self.wanted, &REQUEST, &mut self.rng);
        let text = format!("get me the {}", wording.object(&named, &mut self.rng));
        Turn::now(self.recogniser.hear(&text, &mut self.rng))
    }

    fn answer(&mut self, question: Question) -> Turn {
        if chance(&mut self.rng, self.silent) {
            return Turn::SILENCE;
        }
        let model = self.room.problem.model;
        let answer = if chance(&mut self.rng, self.epsilon) {
            wrong_answer(model, question, self.wanted, &mut self.rng)
        } else {
            Answer::truthful(model, question, self.wanted)
        };
        let text = answer.text(self.room.scene);
        Turn::now(self.recogniser.hear(text, &mut self.rng))
    }
}
