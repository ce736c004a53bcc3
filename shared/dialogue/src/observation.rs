//! The observation model, eq. (1)–(7), and its extensions.
//!
//! | heard | factor per object `D` | source |
//! |---|---|---|
//! | no base word | `1 − p_l` | eq. (4) |
//! | base words | `p_l · Π P(w∣D)`, one factor per word as often as it was said | eq. (4), (5) |
//! | yes or no, question `point` or `attr` | `p_l(1−ε)` if true of `D`, `p_l·ε` if not; neither: `1−p_l` | eq. (6), (7) |
//! | yes or no, nothing asked | `1/3` each | section 3.6.2 |
//! | a value, question `which k` | [`OpenQuestion`] in place of that word's factor | section 7's future work |
//! | yes or no, question `which k` | `1/3` each: no answer to it | extension |
//! | excluded group | `ε` for an object that has all of its words, `1−ε` for others | extension |

use scene::{AttributeId, Question, Reading, Response, ValueId, WordId};

use crate::Model;

/// `ln P(l_b, l_r | D, Q_t, Q_v)` of eq. (1) for every object `D`, in the scene's order.
///
/// Equal entries are equal bit for bit, so an observation that says nothing about the objects is
/// recognised exactly.
///
/// # Panics
/// If the question or the reading is not about the model's scene.
pub fn log_likelihood(model: &Model, question: Question, reading: &Reading) -> Vec<f64> {
    assert!(model.contains(question), "{question:?} is not about this scene");
    let mut log = vec![0.0; model.objects()];
    add_base(model, question, reading, &mut log);
    add_response(model, question, reading.response, &mut log);
    for group in reading.excluded.iter().filter(|group| !group.is_empty()) {
        add_excluded(model, group, &mut log);
    }
    log
}

/// How a person answers "what is its k?": the value that the object has with `1 − ε`, each other
/// value of `V_k` with `ε/(|V_k| − 1)`; silence is `1 − p_l` as for every question.
///
/// An object that lacks the attribute has no true answer; whoever wants it is taken to name any
/// value with the same probability. With one value there is nothing to confuse it with, so `ε`
/// plays no part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OpenQuestion {
    /// Probability of naming the object's own value, given an answer.
    pub own: f64,
    /// Probability of naming one particular other value, given an answer.
    pub other: f64,
    /// Probability of naming any one value of an attribute that the object lacks.
    pub lacking: f64,
}

impl OpenQuestion {
    /// The answer model of "what is its k?".
    pub fn new(model: &Model, k: AttributeId) -> Self {
        let values = model.values(k) as f64;
        let epsilon = model.params().epsilon;
        if values < 2.0 {
            return Self { own: 1.0, other: 0.0, lacking: 1.0 };
        }
        Self { own: 1.0 - epsilon, other: epsilon / (values - 1.0), lacking: 1.0 / values }
    }

    /// Probability of naming `v`, given an answer, of somebody who wants an object with that entry
    /// in the model's column.
    pub fn answer(&self, v: ValueId, entry: u16) -> f64 {
        match entry {
            Model::LACKS => self.lacking,
            own if own == v.0 => self.own,
            _ => self.other,
        }
    }
}

/// The value that answers an open question: what the words name, if they name exactly one.
/// "On the counter or in the cabinet" is no answer, but its words still count.
fn open_answer(
    model: &Model,
    question: Question,
    base: &[WordId],
) -> Option<(AttributeId, ValueId)> {
    let Question::Which(k) = question else { return None };
    let mut named = base.iter().flat_map(|&word| model.meanings(word)).filter(|(of, _)| *of == k);
    let &answer = named.next()?;
    named.all(|&again| again == answer).then_some(answer)
}

/// Eq. (4) and (5), with the answer to an open question in place of its word's own factor.
fn add_base(model: &Model, question: Question, reading: &Reading, log: &mut [f64]) {
    if reading.base.is_empty() {
        return add(log, (1.0 - model.params().p_l).ln());
    }
    add(log, model.params().p_l.ln());
    let answer = open_answer(model, question, &reading.base);
    if let Some((k, v)) = answer {
        let open = OpenQuestion::new(model, k);
        for (entry, &value) in log.iter_mut().zip(model.column(k)) {
            *entry += open.answer(v, value).ln();
        }
    }
    let answering = answer.map(|(k, v)| model.word(k, v));
    for &word in reading.base.iter().filter(|&&word| Some(word) != answering) {
        model.add_log_word(word, log);
    }
}

/// Eq. (6) and (7).
fn add_response(model: &Model, question: Question, response: Response, log: &mut [f64]) {
    let params = model.params();
    let asked_yes_no = matches!(question, Question::Point(_) | Question::Attribute(..));
    if !asked_yes_no {
        return add(log, (1.0_f64 / 3.0).ln());
    }
    let right = (params.p_l * (1.0 - params.epsilon)).ln();
    let wrong = (params.p_l * params.epsilon).ln();
    let (if_true, if_false) = match response {
        Response::None => return add(log, (1.0 - params.p_l).ln()),
        Response::Yes => (right, wrong),
        Response::No => (wrong, right),
    };
    match question {
        Question::Attribute(k, v) => {
            for (entry, &value) in log.iter_mut().zip(model.column(k)) {
                *entry += if value == v.0 { if_true } else { if_false };
            }
        }
        Question::Point(asked) => {
            for (i, entry) in log.iter_mut().enumerate() {
                *entry += if i == asked.index() { if_true } else { if_false };
            }
        }
        Question::None | Question::Which(_) => {}
    }
}

/// "Not the small white one": an error of the person's or of the listening is as likely as in an
/// answer.
fn add_excluded(model: &Model, group: &[WordId], log: &mut [f64]) {
    let epsilon = model.params().epsilon;
    for (i, entry) in log.iter_mut().enumerate() {
        let ruled_out = group.iter().all(|&word| model.has_word(i.into(), word));
        *entry += if ruled_out { epsilon } else { 1.0 - epsilon }.ln();
    }
}

fn add(log: &mut [f64], constant: f64) {
    for entry in log {
        *entry += constant;
    }
}

#[cfg(test)]
mod tests;
