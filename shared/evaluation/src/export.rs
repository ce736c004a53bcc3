//! The decision problem in Cassandra's `.pomdp` text, which public solvers read.
//!
//! The state is the wanted object (or `absent`, if the model allows it), and one more: a pick ends
//! the interaction, so it leads to `end`, where nothing is paid or heard; one that can be denied
//! ([`Announce`](vocabulary::Announce)) may leave the state as it is, with the observation
//! `denied`. Waiting and asking leave the state unchanged (eq. (2), (3)); the answer depends on it
//! by [`Answer::probability`]. The format: A. R. Cassandra, "The POMDP file format".

mod name;

use std::collections::{HashMap, HashSet};
use std::fmt::Write;

use dialogue::{Answer, DecisionProblem};
use scene::{AttributeId, ObjectId, Question, Scene, ValueId};

use vocabulary::Action;

use name::escape;

/// Largest number of pairs of an action and a state that is exported.
pub const PAIRS_MAX: usize = 5_000_000;

/// The problem has more pairs of action and state than a text can sensibly hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "expected at most {PAIRS_MAX} pairs of a state and an action, found {states} states and \
     {actions} actions: too large for this format; help: leave out objects or kinds of question"
)]
pub struct TooLarge {
    /// Number of states.
    pub states: usize,
    /// Number of actions.
    pub actions: usize,
}

/// An exported problem.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pomdp {
    /// The `.pomdp` text.
    pub text: String,
    /// Number of states.
    pub states: usize,
    /// Number of actions.
    pub actions: usize,
    /// Number of observations.
    pub observations: usize,
}

/// Returns the problem that the planners solve as text, below the lines of `comment`. Every
/// question of the action space is included, informative or not. Numbers have as many digits as
/// identify them.
///
/// # Errors
/// If the problem is too large.
///
/// # Panics
/// If `scene` is not the one that the problem's model was made of.
pub fn pomdp(
    scene: &Scene,
    problem: &DecisionProblem<'_>,
    comment: &str,
) -> Result<Pomdp, TooLarge> {
    assert_eq!(scene.objects().len(), problem.model.objects(), "scene and model belong together");
    let writer = Writer::new(scene, problem)?;
    let (states, actions) = (writer.states.len(), writer.actions.len());
    Ok(Pomdp { text: writer.text(comment), states, actions, observations: writer.answers.len() })
}

/// The nonzero entries of a row of the observation matrix: numbers of answers, ascending, and their
/// probabilities.
type Row = Vec<(usize, f64)>;

struct Writer<'a> {
    problem: &'a DecisionProblem<'a>,
    /// Names of the states; the last one is the end.
    states: Vec<String>,
    actions: Vec<(Action, String)>,
    answers: Vec<(Option<Answer>, String)>,
}

impl<'a> Writer<'a> {
    fn new(scene: &Scene, problem: &'a DecisionProblem<'a>) -> Result<Self, TooLarge> {
        let model = problem.model;
        let questions = problem.questions();
        let states = model.hypotheses() + 1;
        let count = 1 + questions.len() + model.objects();
        if states.saturating_mul(count) > PAIRS_MAX {
            return Err(TooLarge { states, actions: count });
        }
        let wanted = scene.objects().iter().map(|object| escape("wanted", &[&object.name]));
        let absent = model.absent().map(|_| escape("absent", &[]));
        let answers = answers(problem, &questions);
        let asks = questions.into_iter().map(Action::Ask);
        let picks = (0..model.objects()).map(|i| Action::Pick(ObjectId::from(i)));
        let actions = std::iter::once(Action::Wait).chain(asks).chain(picks);
        Ok(Self {
            problem,
            states: wanted.chain(absent).chain([escape("end", &[])]).collect(),
            actions: actions.map(|action| (action, action_name(scene, action))).collect(),
            answers: answers.into_iter().map(|a| (a, answer_name(scene, a))).collect(),
        })
    }

    fn end(&self) -> &str {
        self.states.last().map_or("", String::as_str)
    }

    fn text(&self, comment: &str) -> String {
        let mut text = String::new();
        for line in comment.lines() {
            let printable: String =
                line.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
            text += format!("# {printable}").trim_end();
            text.push('\n');
        }
        self.write_preamble(&mut text);
        for (action, name) in &self.actions {
            let _ = match action {
                Action::Pick(_) => writeln!(text, "T: {name} : * : {} 1.0", self.end()),
                Action::Wait | Action::Ask(_) => writeln!(text, "T: {name}\nidentity"),
            };
            for (state, denied) in self.denials(*action) {
                let kept = 1.0 - denied;
                let _ = writeln!(text, "T: {name} : {state} : {} {kept:?}", self.end());
                let _ = writeln!(text, "T: {name} : {state} : {state} {denied:?}");
            }
        }
        text.push('\n');
        for (action, name) in &self.actions {
            self.write_observations(&mut text, *action, name);
        }
        text.push('\n');
        self.write_rewards(&mut text);
        text
    }

    fn write_preamble(&self, text: &mut String) {
        let _ = writeln!(text, "discount: {:?}\nvalues: reward", self.problem.costs.discount);
        let _ = writeln!(text, "states: {}", self.states.join(" "));
        let actions: Vec<&str> = self.actions.iter().map(|(_, name)| name.as_str()).collect();
        let answers: Vec<&str> = self.answers.iter().map(|(_, name)| name.as_str()).collect();
        let _ =
            writeln!(text, "actions: {}\nobservations: {}", actions.join(" "), answers.join(" "));
        let hypotheses = self.problem.model.hypotheses();
        let uniform = format!("{:?} ", 1.0 / hypotheses as f64).repeat(hypotheses);
        let _ = writeln!(text, "start: {uniform}0.0\n");
    }

    /// Returns the states in which an action can be denied, with the probability of that.
    fn denials(&self, action: Action) -> Vec<(&str, f64)> {
        let DecisionProblem { model, announce, .. } = *self.problem;
        let Action::Pick(picked) = action else { return Vec::new() };
        if announce.is_final() {
            return Vec::new();
        }
        let (own, other) = announce.denials(model.params().epsilon);
        let denied = |state: usize| if state == picked.index() { own } else { other };
        let states = self.states[..model.hypotheses()].iter().enumerate();
        states.map(|(state, name)| (name.as_str(), denied(state))).collect()
    }

    /// Writes the most frequent row for all states, then the differing ones.
    fn write_observations(&self, text: &mut String, action: Action, name: &str) {
        let silence: Row = vec![(0, 1.0)];
        let rows: Vec<Row> = match action {
            Action::Ask(question) => self.rows(question).chain([silence]).collect(),
            Action::Wait | Action::Pick(_) => vec![silence],
        };
        let common = most_frequent(&rows);
        let mut line = |state: &str, answer: usize, p: f64| {
            let _ = writeln!(text, "O: {name} : {state} : {} {p:?}", self.answers[answer].1);
        };
        common.iter().for_each(|&(answer, p)| line("*", answer, p));
        for (state, _) in self.denials(action) {
            line(state, 0, 0.0);
            line(state, self.answers.len() - 1, 1.0);
        }
        for (state, row) in self.states.iter().zip(&rows) {
            let changed = row.iter().filter(|entry| !common.contains(entry));
            changed.for_each(|&(answer, p)| line(state, answer, p));
            let gone = common.iter().filter(|(answer, _)| row.iter().all(|(a, _)| a != answer));
            gone.for_each(|&(answer, _)| line(state, answer, 0.0));
        }
    }

    /// Returns the answers to a question for each wanted object.
    fn rows(&self, question: Question) -> impl Iterator<Item = Row> {
        let model = self.problem.model;
        let possible = Answer::possible(model, question);
        let numbered = self.answers.iter().enumerate();
        let heard: Vec<(usize, Answer)> = numbered
            .filter_map(|(number, (answer, _))| Some((number, (*answer)?)))
            .filter(|(_, answer)| possible.contains(answer))
            .collect();
        (0..model.hypotheses()).map(ObjectId::from).map(move |wanted| {
            let of = |&(number, answer): &(usize, Answer)| {
                (number, answer.probability(model, question, wanted))
            };
            heard.iter().map(of).filter(|(_, p)| *p != 0.0).collect()
        })
    }

    fn write_rewards(&self, text: &mut String) {
        let costs = self.problem.costs;
        for (action, name) in &self.actions {
            let paid = match action {
                Action::Pick(_) => -costs.wrong,
                asking => -self.problem.cost(*asking),
            };
            let _ = writeln!(text, "R: {name} : * : * : * {paid:?}");
            if let Action::Pick(object) = action {
                let wanted = &self.states[object.index()];
                let _ = writeln!(text, "R: {name} : {wanted} : * : * {:?}", costs.correct);
            }
            for (state, _) in self.denials(*action) {
                let cost_s = -self.problem.announce.cost_s;
                let _ = writeln!(text, "R: {name} : {state} : {state} : * {cost_s:?}");
            }
        }
        let _ = writeln!(text, "R: * : {} : * : * 0.0", self.end());
    }
}

/// Returns every answer that a question can get, silence first, and last the denial of a pick
/// (`None`), if there is one.
fn answers(problem: &DecisionProblem<'_>, questions: &[Question]) -> Vec<Option<Answer>> {
    let possible = |question: &Question| Answer::possible(problem.model, *question);
    let plain = [Answer::Silence, Answer::Yes, Answer::No];
    let mut heard = HashSet::from([Answer::Silence]);
    let told: Vec<Answer> =
        questions.iter().flat_map(possible).filter(|it| heard.insert(*it)).collect();
    let mut answers: Vec<Answer> = plain.into_iter().filter(|it| heard.contains(it)).collect();
    answers.extend(told.into_iter().filter(|answer| !plain.contains(answer)));
    let denied = (!problem.announce.is_final()).then_some(None);
    answers.into_iter().map(Some).chain(denied).collect()
}

/// Returns the row that most states have; among equals the first one.
fn most_frequent(rows: &[Row]) -> &[(usize, f64)] {
    let mut counts: HashMap<Vec<(usize, u64)>, (usize, usize)> = HashMap::new();
    for (state, row) in rows.iter().enumerate() {
        let bits = row.iter().map(|(answer, p)| (*answer, p.to_bits())).collect();
        counts.entry(bits).or_insert((0, state)).0 += 1;
    }
    let most = counts.into_values().max_by_key(|&(count, first)| (count, usize::MAX - first));
    most.map_or(&[], |(_, state)| &rows[state])
}

fn action_name(scene: &Scene, action: Action) -> String {
    let object = |i: ObjectId| scene.object(i).name.as_str();
    match action {
        Action::Wait | Action::Ask(Question::None) => escape("wait", &[]),
        Action::Pick(i) => escape("pick", &[object(i)]),
        Action::Ask(Question::Point(i)) => escape("point", &[object(i)]),
        Action::Ask(Question::Which(k)) => escape("which", &[attribute_name(scene, k)]),
        Action::Ask(Question::Choice(k, options)) => {
            let values = options.values().iter().map(|v| value_name(scene, k, *v));
            let names: Vec<&str> =
                std::iter::once(attribute_name(scene, k)).chain(values).collect();
            escape("choice", &names)
        }
        Action::Ask(Question::Attribute(k, v)) => {
            escape("is", &[attribute_name(scene, k), value_name(scene, k, v)])
        }
    }
}

fn answer_name(scene: &Scene, answer: Option<Answer>) -> String {
    match answer {
        None => escape("denied", &[]),
        Some(Answer::Silence) => escape("silence", &[]),
        Some(Answer::Yes) => escape("yes", &[]),
        Some(Answer::No) => escape("no", &[]),
        Some(Answer::Value(k, v)) => {
            escape("says", &[attribute_name(scene, k), value_name(scene, k, v)])
        }
    }
}

fn attribute_name(scene: &Scene, k: AttributeId) -> &str {
    &scene.attributes()[k.index()].name
}

fn value_name(scene: &Scene, k: AttributeId, v: ValueId) -> &str {
    &scene.attributes()[k.index()].values[v.index()].name
}
