//! Users who talk in sentences: by value, with more than was asked, corrections, hedges, and late.

use scene::{AttributeId, ObjectId, Question, Role, ValueId};
use vocabulary::Rng;

use super::recogniser::Recogniser;
use super::wording::{Wording, number, own_values};
use super::{Domain, Turn, answer_or_slip};
use crate::simulation::draw::{chance, one_of};

/// Seconds by which a late answer is late: least and most.
const LATE_S: (f64, f64) = (2.0, 20.0);
const AGAIN: [&str; 3] = ["sorry, what was that?", "can you repeat that?", "what did you say?"];
const NEITHER: [&str; 3] = ["neither", "none of them", "no, something else"];
const YES_HEDGED: [&str; 3] = ["i think so", "yes i think so", "i guess so"];
const NO_HEDGED: [&str; 3] = ["i don't think so", "no i don't think so", "probably not"];

/// A user's habits of speech. Lists of probabilities are in the order of their description.
#[derive(Clone, Debug, PartialEq)]
pub struct Manners {
    verbs: &'static [&'static str],
    yes: &'static [&'static str],
    no: &'static [&'static str],
    it_is: &'static str,
    /// Probability of naming a value by a synonym, if it has one.
    synonyms: f64,
    /// Probability of each number of values in the request: none, one, two, ….
    request: &'static [f64],
    /// Probability of a wrong answer.
    slip: f64,
    /// Probability of leaving a question unanswered.
    silent: f64,
    /// Probability of an answer that comes late.
    late: f64,
    /// Probability of saying something while the robot waits.
    speaks_up: f64,
    /// Probability of attending to the robot's announcements.
    attends: f64,
    /// Answers to a yes/no question: plain, by value, hedged, corrected, with another value, asking
    /// for a repetition.
    closed: [f64; 6],
    /// Answers to an open question: a word, a sentence, hedged, corrected, with another value,
    /// asking for a repetition.
    open: [f64; 6],
    /// Probability that an answer by value leaves out the yes or no.
    value_alone: f64,
    recogniser: Recogniser,
}

impl Manners {
    /// The `human` of a study.
    pub const EVERYDAY: Self = Self {
        verbs: &["get me", "bring me", "i would like", "please get"],
        yes: &["yes", "yeah", "yep", "yes it is", "right", "yes please"],
        no: &["no", "nope", "no it is not", "no it isn't", "nah"],
        it_is: "it's",
        synonyms: 0.35,
        request: &[0.35, 0.35, 0.2, 0.1],
        slip: 0.03,
        silent: 0.05,
        late: 0.08,
        speaks_up: 0.7,
        attends: 0.85,
        closed: [0.52, 0.22, 0.08, 0.05, 0.10, 0.03],
        open: [0.40, 0.30, 0.08, 0.07, 0.12, 0.03],
        value_alone: 0.5,
        recogniser: Recogniser::GOOD,
    };

    /// A user who always answers and never errs: for tests with real sound, whose recogniser adds
    /// the errors.
    pub const ATTENTIVE: Self = Self {
        verbs: &["get me", "bring me", "please get me", "i want", "hand me"],
        yes: &["yes", "yeah", "yes it is", "yes please", "sure"],
        no: &["no", "nope", "no it is not", "no it isn't"],
        it_is: "it is",
        synonyms: 0.15,
        request: &[0.5, 0.35, 0.15],
        slip: 0.0,
        silent: 0.0,
        late: 0.0,
        speaks_up: 1.0,
        attends: 1.0,
        closed: [0.6, 0.3, 0.0, 0.0, 0.1, 0.0],
        open: [0.5, 0.5, 0.0, 0.0, 0.0, 0.0],
        value_alone: 0.17,
        recogniser: Recogniser::PERFECT,
    };

    pub(super) fn speaker<'a>(
        &'static self,
        domain: Domain<'a>,
        wanted: ObjectId,
        rng: &'a mut Rng,
    ) -> Speaker<'a> {
        let wording = Wording { scene: domain.scene, synonyms: self.synonyms };
        Speaker { manners: self, domain, wanted, wording, rng }
    }
}

/// A user with these manners who is about to speak.
pub(super) struct Speaker<'a> {
    manners: &'static Manners,
    domain: Domain<'a>,
    wanted: ObjectId,
    wording: Wording<'a>,
    rng: &'a mut Rng,
}

impl Speaker<'_> {
    pub(super) fn request(&mut self) -> Turn {
        let named = own_values(self.domain.scene, self.wanted, self.manners.request, self.rng);
        let verb = self.choose(self.manners.verbs);
        let text = format!("{verb} the {}", self.wording.object(&named, self.rng));
        Turn { late_s: 0.0, ..self.say(&text) }
    }

    pub(super) fn answer(&mut self, question: Question) -> Turn {
        let manners = self.manners;
        let waiting = question == Question::None;
        if chance(self.rng, if waiting { 1.0 - manners.speaks_up } else { manners.silent }) {
            return Turn::SILENT;
        }
        if waiting {
            let Some(value) = self.own_value() else { return Turn::SILENT };
            let text = self.statement(value);
            return self.say(&text);
        }
        let model = self.domain.model;
        let text = match answer_or_slip(model, question, self.wanted, manners.slip, self.rng) {
            dialogue::Answer::Yes => self.yes_or_no(question, true),
            dialogue::Answer::No if matches!(question, Question::Choice(..)) => {
                self.choose(&NEITHER)
            }
            dialogue::Answer::No => self.yes_or_no(question, false),
            dialogue::Answer::Value(k, v) => self.open((k, v)),
            dialogue::Answer::Silence => "i don't know".to_owned(),
        };
        self.say(&text)
    }

    /// Returns the reaction to an announced object: none to the right one, except for a slip.
    pub(super) fn objection(&mut self, object: ObjectId) -> Turn {
        let manners = self.manners;
        let (model, question) = (self.domain.model, Question::Point(object));
        let attends = chance(self.rng, manners.attends);
        match answer_or_slip(model, question, self.wanted, manners.slip, self.rng) {
            dialogue::Answer::No if attends => {
                let text = self.yes_or_no(question, false);
                self.say(&text)
            }
            _ => Turn::SILENT,
        }
    }

    /// Yes or no to `question`, in words.
    fn yes_or_no(&mut self, question: Question, yes: bool) -> String {
        let plain = if yes { self.manners.yes } else { self.manners.no };
        match number(&self.manners.closed, self.rng) {
            1 => self.by_value(question, yes),
            2 => self.choose(if yes { &YES_HEDGED } else { &NO_HEDGED }),
            3 if yes => "no, wait, yes".to_owned(),
            3 => "yes, no wait, no".to_owned(),
            4 => match self.own_value() {
                Some(value) => {
                    let more = self.wording.predicate(value, self.rng);
                    format!("{}, {} {more}", self.choose(plain), self.manners.it_is)
                }
                None => self.choose(plain),
            },
            5 => self.choose(&AGAIN),
            _ => self.choose(plain),
        }
    }

    /// "The metal one" to "Is it plastic?": the own value of the attribute in question.
    fn by_value(&mut self, question: Question, yes: bool) -> String {
        let value = match question {
            Question::Attribute(k, v) if yes => Some((k, v)),
            Question::Attribute(k, _) => self.domain.model.value(self.wanted, k).map(|v| (k, v)),
            _ => self.own_value(),
        };
        let plain = if yes { self.manners.yes } else { self.manners.no };
        let Some(value) = value else { return self.choose(plain) };
        let statement = self.statement(value);
        if chance(self.rng, self.manners.value_alone) {
            return statement;
        }
        format!("{}, {statement}", if yes { "yes" } else { "no" })
    }

    /// The value of an open question, in words.
    fn open(&mut self, value: (AttributeId, ValueId)) -> String {
        match number(&self.manners.open, self.rng) {
            1 => self.statement(value),
            2 => format!("{}, i think", self.wording.value(value, self.rng)),
            3 => match self.another_of(value) {
                Some(other) => {
                    let other = self.wording.value(other, self.rng);
                    format!("{other}, no, {}", self.wording.value(value, self.rng))
                }
                None => self.wording.value(value, self.rng),
            },
            4 => match self.own_value() {
                Some(more) => {
                    let more = self.wording.predicate(more, self.rng);
                    format!("{} and {} {more}", self.statement(value), self.manners.it_is)
                }
                None => self.statement(value),
            },
            5 => self.choose(&AGAIN),
            _ => self.wording.value(value, self.rng),
        }
    }

    /// "It's white", "the white one", "the one in the cabinet".
    fn statement(&mut self, (k, v): (AttributeId, ValueId)) -> String {
        let role = self.domain.scene.attributes()[k.index()].values[v.index()].role();
        let predicate = self.wording.predicate((k, v), self.rng);
        match role {
            Role::Place if chance(self.rng, 0.5) => format!("the one {predicate}"),
            Role::Quality if chance(self.rng, 0.5) => format!("the {predicate} one"),
            _ => format!("{} {predicate}", self.manners.it_is),
        }
    }

    /// Any value that the wanted object has.
    fn own_value(&mut self) -> Option<(AttributeId, ValueId)> {
        own_values(self.domain.scene, self.wanted, &[0.0, 1.0], self.rng).first().copied()
    }

    /// Another value of the same attribute.
    fn another_of(&mut self, (k, v): (AttributeId, ValueId)) -> Option<(AttributeId, ValueId)> {
        let all = (0..self.domain.model.values(k)).map(ValueId::from);
        let others: Vec<_> = all.filter(|other| *other != v).map(|other| (k, other)).collect();
        one_of(self.rng, &others).copied()
    }

    fn choose(&mut self, list: &[&str]) -> String {
        one_of(self.rng, list).map_or_else(String::new, |text| (*text).to_owned())
    }

    fn say(&mut self, text: &str) -> Turn {
        let reply = self.manners.recogniser.hear(text, self.domain.scene, self.rng);
        let late = chance(self.rng, self.manners.late);
        Turn { reply, late_s: if late { self.rng.between(LATE_S) } else { 0.0 } }
    }
}
