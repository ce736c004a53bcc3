//! People as they talk: by value, with more than was asked, corrections, hedges, and late.

use dialogue::{Answer, Rng};
use scene::{AttributeId, ObjectId, Question, Role, ValueId};

use super::recogniser::Recogniser;
use super::wording::{Wording, number, own_values};
use super::{Turn, User, wrong_answer};
use crate::simulation::draw::{between, chance, one_of};
use crate::simulation::interaction::Room;

/// How many values the request names, by probability: none, one, two, three.
const REQUEST: [f64; 4] = [0.35, 0.35, 0.2, 0.1];
/// Probability of saying what is not so.
const SLIP: f64 = 0.03;
/// Probability of leaving a question unanswered.
const SILENT: f64 = 0.05;
/// Probability of an answer that takes its time, and how much, seconds.
const LATE: (f64, (f64, f64)) = (0.08, (2.0, 20.0));
/// Probability of saying something while the robot waits.
const PRESSES: f64 = 0.7;
/// Manners of an answer to a yes/no question, by probability: plain, by value, hedged, corrected,
/// with another value, asking to hear it again.
const MANNERS: [f64; 6] = [0.52, 0.22, 0.08, 0.05, 0.10, 0.03];
/// Manners of an answer to an open question: a word, a sentence, hedged, corrected, with another
/// value, asking to hear it again.
const OPEN_MANNERS: [f64; 6] = [0.40, 0.30, 0.08, 0.07, 0.12, 0.03];

const YES: [&str; 6] = ["yes", "yeah", "yep", "yes it is", "right", "yes please"];
const NO: [&str; 5] = ["no", "nope", "no it is not", "no it isn't", "nah"];
const YES_HEDGED: [&str; 3] = ["i think so", "yes i think so", "i guess so"];
const NO_HEDGED: [&str; 3] = ["i don't think so", "no i don't think so", "probably not"];
const AGAIN: [&str; 3] = ["sorry, what was that?", "can you repeat that?", "what did you say?"];

/// Somebody who talks as people do.
pub(super) struct Human<'a> {
    room: Room<'a>,
    wanted: ObjectId,
    rng: Rng,
    wording: Wording<'a>,
    recogniser: Recogniser<'a>,
}

impl<'a> Human<'a> {
    pub(super) fn new(room: &Room<'a>, wanted: ObjectId, rng: Rng) -> Self {
        let (wording, recogniser) = (Wording::varied(room.scene), Recogniser::good(room.scene));
        Self { room: *room, wanted, rng, wording, recogniser }
    }

    /// Yes or no to `question`, in words.
    fn yes_or_no(&mut self, question: Question, yes: bool) -> String {
        let plain = if yes { &YES[..] } else { &NO[..] };
        match number(&MANNERS, &mut self.rng) {
            1 => self.by_value(question, yes),
            2 => self.pick(if yes { &YES_HEDGED } else { &NO_HEDGED }),
            3 if yes => "no, wait, yes".to_owned(),
            3 => "yes, no wait, no".to_owned(),
            4 => match self.own_value() {
                Some(value) => {
                    let more = self.wording.predicate(value, &mut self.rng);
                    format!("{}, it's {more}", self.pick(plain))
                }
                None => self.pick(plain),
            },
            5 => self.pick(&AGAIN),
            _ => self.pick(plain),
        }
    }

    /// "The metal one" to "Is it plastic?": the own value of the attribute that was asked about.
    fn by_value(&mut self, question: Question, yes: bool) -> String {
        let value = match question {
            Question::Attribute(k, v) if yes => Some((k, v)),
            Question::Attribute(k, _) => {
                self.room.problem.model.value(self.wanted, k).map(|v| (k, v))
            }
            _ => self.own_value(),
        };
        let Some(value) = value else { return self.pick(if yes { &YES } else { &NO }) };
        let said = self.statement(value);
        if chance(&mut self.rng, 0.5) {
            return said;
        }
        format!("{}, {said}", if yes { "yes" } else { "no" })
    }

    /// The value of an open question, in words.
    fn open(&mut self, value: (AttributeId, ValueId)) -> String {
        match number(&OPEN_MANNERS, &mut self.rng) {
            1 => self.statement(value),
            2 => format!("{}, i think", self.wording.value(value, &mut self.rng)),
            3 => match self.another_of(value) {
                Some(other) => {
                    let other = self.wording.value(other, &mut self.rng);
                    format!("{other}, no, {}", self.wording.value(value, &mut self.rng))
                }
                None => self.wording.value(value, &mut self.rng),
            },
            4 => match self.own_value() {
                Some(more) => {
                    let more = self.wording.predicate(more, &mut self.rng);
                    format!("{} and it's {more}", self.statement(value))
                }
                None => self.statement(value),
            },
            5 => self.pick(&AGAIN),
            _ => self.wording.value(value, &mut self.rng),
        }
    }

    /// "It's white", "the white one", "in the cabinet".
    fn statement(&mut self, (k, v): (AttributeId, ValueId)) -> String {
        let role = self.room.scene.attributes()[k.index()].values[v.index()].role();
        let predicate = self.wording.predicate((k, v), &mut self.rng);
        match role {
            Role::Place if chance(&mut self.rng, 0.5) => format!("the one {predicate}"),
            Role::Quality if chance(&mut self.rng, 0.5) => format!("the {predicate} one"),
            _ => format!("it's {predicate}"),
        }
    }

    /// Some value that the wanted object has.
    fn own_value(&mut self) -> Option<(AttributeId, ValueId)> {
        own_values(self.room.scene, self.wanted, &[0.0, 1.0], &mut self.rng).first().copied()
    }

    /// Another value of the same attribute.
    fn another_of(&mut self, (k, v): (AttributeId, ValueId)) -> Option<(AttributeId, ValueId)> {
        let all = (0..self.room.problem.model.values(k)).map(ValueId::from);
        let others: Vec<_> = all.filter(|other| *other != v).map(|other| (k, other)).collect();
        one_of(&mut self.rng, &others).copied()
    }

    fn pick(&mut self, list: &[&str]) -> String {
        one_of(&mut self.rng, list).map_or_else(String::new, |text| (*text).to_owned())
    }

    fn say(&mut self, text: &str) -> Turn {
        let said = self.recogniser.hear(text, &mut self.rng);
        let late = chance(&mut self.rng, LATE.0);
        Turn { said, late_s: if late { between(&mut self.rng, LATE.1) } else { 0.0 } }
    }
}

impl User for Human<'_> {
    fn wanted(&self) -> ObjectId {
        self.wanted
    }

    fn request(&mut self) -> Turn {
        let named = own_values(self.room.scene, self.wanted, &REQUEST, &mut self.rng);
        let verb = self.pick(&["get me", "bring me", "i would like", "please get"]);
        let text = format!("{verb} the {}", self.wording.object(&named, &mut self.rng));
        Turn { late_s: 0.0, ..self.say(&text) }
    }

    fn answer(&mut self, question: Question) -> Turn {
        let silent = if question == Question::None { 1.0 - PRESSES } else { SILENT };
        if chance(&mut self.rng, silent) {
            return Turn::SILENCE;
        }
        if question == Question::None {
            let Some(value) = self.own_value() else { return Turn::SILENCE };
            let text = self.statement(value);
            return self.say(&text);
        }
        let model = self.room.problem.model;
        let answer = if chance(&mut self.rng, SLIP) {
            wrong_answer(model, question, self.wanted, &mut self.rng)
        } else {
            Answer::truthful(model, question, self.wanted)
        };
        let text = match answer {
            Answer::Yes => self.yes_or_no(question, true),
            Answer::No => self.yes_or_no(question, false),
            Answer::Value(k, v) => self.open((k, v)),
            Answer::Silence => "i don't know".to_owned(),
        };
        self.say(&text)
    }
}
