//! A planner as a program in any language: `whichone-policy --planner-program PROGRAM [ARGUMENT…]`.
//!
//! The program writes the line `ready` once it is. Then it reads a line of JSON on standard input
//! for each decision, a `Request`, and answers with a line on standard output, a `Reply`. It
//! ends with its input; its standard error is logged. It decides by the request alone.

use std::io::{self, BufRead, BufReader, Write};
use std::process::{Child, Command, Stdio};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use crossbeam_channel::{Receiver, RecvTimeoutError, Sender, bounded};
use dialogue::registry::{self, Entry};
use dialogue::{Answer, Belief, Decision, DecisionProblem, Model, Planner, Step};
use scene::{ObjectId, Question};
use serde::{Deserialize, Serialize};
use service::exit::{Exit, Failure};
use vocabulary::{Action, Costs};

/// Name of the planner.
pub const NAME: &str = "program";
/// Planner that decides if the program does not, and that values its decisions.
const FALLBACK: &str = "entropy";
/// Time that the program may take to become ready, before the service is.
const START_MAX: Duration = Duration::from_secs(5);
/// Line that the program writes once it is ready.
const READY: &str = "ready";
/// Time that a decision may take. The service sends no heartbeat meanwhile.
const ANSWER_MAX: Duration = Duration::from_millis(1_500);

/// The command line of the program.
static COMMAND: Mutex<Vec<String>> = Mutex::new(Vec::new());

/// Adds the planner [`NAME`] to the registry; it runs this command line.
///
/// # Errors
/// The command line is empty.
pub fn register(command: &[String]) -> Result<(), Failure> {
    if command.is_empty() {
        let what =
            "--planner-program: the program is missing; help: --planner-program python3 planner.py";
        return Err(Failure::new(Exit::Usage, what));
    }
    *COMMAND.lock().unwrap_or_else(PoisonError::into_inner) = command.to_vec();
    let about = "Asks a program.";
    // Added once, whatever command it runs.
    let _ = registry::add(Entry { name: NAME, about, make: || Box::new(ProgramPlanner::new()) });
    Ok(())
}

/// Request to the program.
#[derive(Debug, Serialize)]
struct Request {
    /// Number of the interaction, and of the decision in it: the only source of randomness.
    interaction: u64,
    step: u32,
    /// Probability of each object, in the order of the scene, and of an absent one if allowed.
    belief: Vec<f64>,
    /// Values of a right pick, a wrong one (negative) and waiting, and the discount per action.
    correct: f64,
    wrong: f64,
    wait: f64,
    discount: f64,
    questions: Vec<Candidate>,
}

/// A question that may be asked.
#[derive(Debug, Serialize)]
struct Candidate {
    kind: &'static str,
    /// Number of the attribute in the scene, of its value, and of the object, if there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    attribute: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    value: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    object: Option<usize>,
    /// Numbers of the values of a choice.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    values: Vec<usize>,
    /// Cost in the unit of the picks' values.
    cost: f64,
    /// For each answer, silence the last, its probability given each object.
    answers: Vec<Vec<f64>>,
}

/// Answer of the program: a question, a pick, or neither, to wait.
#[derive(Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
struct Reply {
    /// Place in the questions.
    ask: Option<usize>,
    /// Number of the object.
    pick: Option<usize>,
    /// Expected return, if the program knows it.
    value: Option<f64>,
}

impl Request {
    fn new(
        problem: &DecisionProblem<'_>,
        questions: &[Question],
        belief: &Belief,
        step: Step,
    ) -> Self {
        let Costs { correct, wrong, discount, .. } = problem.costs;
        Self {
            interaction: step.interaction,
            step: step.step,
            belief: belief.probabilities(),
            correct,
            wrong: -wrong,
            wait: problem.costs.wait_value(),
            discount,
            questions: questions.iter().map(|it| Candidate::new(problem, *it, belief)).collect(),
        }
    }
}

impl Candidate {
    fn new(problem: &DecisionProblem<'_>, question: Question, belief: &Belief) -> Self {
        let (kind, attribute, value, object) = match question {
            Question::Attribute(k, v) => ("attribute", Some(k.index()), Some(v.index()), None),
            Question::Which(k) => ("which", Some(k.index()), None, None),
            Question::Choice(k, _) => ("choice", Some(k.index()), None, None),
            Question::Point(i) => ("point", None, None, Some(i.index())),
            Question::None => ("none", None, None, None),
        };
        let objects = || (0..belief.len()).map(ObjectId::from);
        let likelihood = |answer: Answer| {
            objects().map(|i| answer.probability(problem.model, question, i)).collect()
        };
        let answers =
            Answer::possible(problem.model, question).into_iter().map(likelihood).collect();
        let values = match question {
            Question::Choice(_, options) => options.values().iter().map(|v| v.index()).collect(),
            _ => Vec::new(),
        };
        let cost = problem.cost(Action::Ask(question));
        Self { kind, attribute, value, object, values, cost, answers }
    }
}

impl Reply {
    /// Returns the named action; an error states the expected form.
    fn action(&self, model: &Model, questions: &[Question]) -> Result<Action, String> {
        let beyond = |what: &str, count: usize, found: usize| {
            format!("expected {what} from 0 to {}, found {found}", count.saturating_sub(1))
        };
        match (self.ask, self.pick) {
            (None, None) => Ok(Action::Wait),
            (Some(ask), None) => {
                let question = questions.get(ask).copied().map(Action::Ask);
                question.ok_or_else(|| beyond("a question", questions.len(), ask))
            }
            (None, Some(pick)) if pick < model.objects() => Ok(Action::Pick(pick.into())),
            (None, Some(pick)) => Err(beyond("an object", model.objects(), pick)),
            (Some(_), Some(_)) => Err("expected a question or a pick, found both".to_owned()),
        }
    }
}

/// The planner. The program is started with it, and again if it has failed.
struct ProgramPlanner {
    fallback: Box<dyn Planner + Send>,
    running: Option<Running>,
}

impl ProgramPlanner {
    fn new() -> Self {
        let fallback = registry::planner(FALLBACK).expect("a planner of the crate itself");
        let mut planner = Self { fallback, running: None };
        planner.start();
        if let Some(running) = &mut planner.running
            && let Err(reason) = running.wait_ready(START_MAX)
        {
            tracing::warn!(reason, "the planner's program is not ready");
        }
        planner
    }

    fn start(&mut self) {
        self.running = Running::start()
            .inspect_err(|error| tracing::warn!(%error, "the planner's program cannot be started"))
            .ok();
    }

    /// Returns the program's action and its value.
    fn ask(
        &mut self,
        request: &Request,
        model: &Model,
        questions: &[Question],
    ) -> Result<(Action, Option<f64>), String> {
        let line = serde_json::to_string(request).map_err(|error| error.to_string())?;
        let running = self.running.as_mut().ok_or("it has not been started")?;
        running.wait_ready(ANSWER_MAX)?;
        let answer = running.ask(line)?;
        let reply: Reply = serde_json::from_str(&answer).map_err(|error| {
            format!("expected {{\"ask\": N}}, {{\"pick\": N}} or {{}}, found {answer:.80}: {error}")
        })?;
        Ok((reply.action(model, questions)?, reply.value.filter(|value| value.is_finite())))
    }
}

impl Planner for ProgramPlanner {
    fn name(&self) -> &'static str {
        NAME
    }

    fn decide(&mut self, problem: &DecisionProblem<'_>, belief: &Belief, step: Step) -> Decision {
        let questions = problem.questions();
        let request = Request::new(problem, &questions, belief, step);
        let known = self.fallback.decide(problem, belief, step);
        match self.ask(&request, problem.model, &questions) {
            Ok((action, value)) => chosen(known, action, value, problem.costs.wait_value()),
            Err(reason) => {
                tracing::warn!(reason, "the planner's program has not decided; {FALLBACK} does");
                self.start();
                known
            }
        }
    }
}

/// The decision for `action`: the actions that `known` weighs are the alternatives.
fn chosen(known: Decision, action: Action, value: Option<f64>, wait: f64) -> Decision {
    let Decision { mut alternatives, .. } = known;
    alternatives.insert(0, (known.action, known.value));
    let weighed = alternatives.iter().find(|(other, _)| *other == action).map(|it| it.1);
    alternatives.retain(|(other, _)| *other != action);
    alternatives.truncate(Decision::ALTERNATIVES_MAX);
    let expected_questions = match action {
        Action::Ask(_) => known.expected_questions.max(1.0),
        Action::Wait | Action::Pick(_) => 0.0,
    };
    Decision {
        action,
        value: value.or(weighed).unwrap_or(wait),
        alternatives,
        expected_questions,
        bounds: None,
    }
}

/// The running program. Two threads write to it and read from it, lest it stop the service.
struct Running {
    program: Child,
    requests: Sender<String>,
    answers: Receiver<io::Result<String>>,
    is_ready: bool,
}

impl Running {
    fn start() -> io::Result<Self> {
        let command = COMMAND.lock().unwrap_or_else(PoisonError::into_inner).clone();
        let Some((name, arguments)) = command.split_first() else {
            return Err(io::Error::other("the planner's program is missing"));
        };
        let started =
            Command::new(name).args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn();
        let mut program =
            started.map_err(|error| io::Error::new(error.kind(), format!("{name}: {error}")))?;
        let (input, output) = (program.stdin.take(), program.stdout.take());
        let (requests, lines) = bounded::<String>(1);
        let (found, answers) = bounded(1);
        std::thread::Builder::new().name("planner-in".to_owned()).spawn(move || {
            let Some(mut input) = input else { return };
            for line in lines {
                if writeln!(input, "{line}").and_then(|()| input.flush()).is_err() {
                    return;
                }
            }
        })?;
        std::thread::Builder::new().name("planner-out".to_owned()).spawn(move || {
            let Some(output) = output else { return };
            for line in BufReader::new(output).lines() {
                if found.send(line).is_err() {
                    return;
                }
            }
        })?;
        Ok(Self { program, requests, answers, is_ready: false })
    }

    /// Waits until the program is ready.
    fn wait_ready(&mut self, within: Duration) -> Result<(), String> {
        if !self.is_ready {
            match self.read(within)? {
                line if line.trim() == READY => self.is_ready = true,
                line => return Err(format!("expected `{READY}` first, found {line:.80}")),
            }
        }
        Ok(())
    }

    fn ask(&self, line: String) -> Result<String, String> {
        self.requests.try_send(line).map_err(|_| "it has ended".to_owned())?;
        self.read(ANSWER_MAX)
    }

    fn read(&self, within: Duration) -> Result<String, String> {
        match self.answers.recv_timeout(within) {
            Ok(line) => line.map_err(|error| error.to_string()),
            Err(RecvTimeoutError::Timeout) => {
                Err(format!("it has written nothing in {} ms", within.as_millis()))
            }
            Err(RecvTimeoutError::Disconnected) => Err("it has ended".to_owned()),
        }
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        // It may have ended.
        let _ = self.program.kill();
        let _ = self.program.wait();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use scene::Scene;
    use vocabulary::{Actions, Params};

    fn model() -> Model {
        let bowls = include_str!("../../../config/scenes/bowls.toml");
        Model::new(&Scene::from_toml("bowls", bowls).unwrap(), Params::default())
    }

    /// The decision of a program in `sh`.
    fn decision(script: &str) -> (Decision, Decision) {
        let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
        let command: Vec<String> = ["sh", "-c", script].map(str::to_owned).to_vec();
        register(&command).unwrap();
        let model = model();
        let problem = DecisionProblem::new(&model, Costs::default(), Actions::default());
        let belief = Belief::uniform(model.hypotheses());
        let decide =
            |name| registry::planner(name).unwrap().decide(&problem, &belief, Step::default());
        (decide(NAME), decide(FALLBACK))
    }

    /// The command is one for the whole process.
    static ALONE: Mutex<()> = Mutex::new(());

    #[test]
    fn program_decides_with_its_value() {
        let (pick, _) = decision(r#"echo ready; read line; echo '{"pick": 2, "value": 7.5}'"#);
        assert_eq!((pick.action, pick.value), (Action::Pick(2.into()), 7.5));
        let (ask, known) = decision(r#"echo ready; read line; echo '{"ask": 3}'"#);
        let problem_questions = model().questions(Actions::default());
        assert_eq!(ask.action, Action::Ask(problem_questions[3]));
        assert!(ask.alternatives.iter().all(|(action, _)| *action != ask.action), "{ask:?}");
        assert!(ask.value <= known.value, "valued as the fallback does: {ask:?}");
        let (wait, known) = decision("echo ready; read line; echo '{}'");
        assert_eq!(wait.action, Action::Wait);
        assert_eq!(wait.alternatives[0], (known.action, known.value));
    }

    #[test]
    #[ignore = "needs python3"]
    fn program_sees_the_whole_problem() {
        // Counted by the program: 16 questions, six objects, probabilities that sum to 1.
        let script = r#"exec python3 -c '
import json
print("ready", flush=True)
request = json.loads(input())
ok = len(request["questions"]) == 16 and len(request["belief"]) == 6
ok = ok and all(abs(sum(of) - 1) < 1e-12 for q in request["questions"] for of in zip(*q["answers"]))
ok = ok and request["wrong"] < 0 < request["correct"] and request["step"] == 0
print(json.dumps({"pick": 5} if ok else {}), flush=True)
'"#;
        assert_eq!(decision(script).0.action, Action::Pick(5.into()));
    }

    #[test]
    fn program_that_does_not_decide_is_replaced() {
        for script in [
            "exit 1",
            "echo ready; read line",
            "echo ready; read line; echo nonsense",
            r#"echo ready; read line; echo '{"ask": 99}'"#,
            r#"echo ready; read line; echo '{"pick": 6}'"#,
            r#"echo ready; read line; echo '{"ask": 1, "pick": 1}'"#,
            r#"echo ready; read line; echo '{"buy": 1}'"#,
            r#"read line; echo '{"pick": 1}'"#,
            "echo ready; exec sleep 60",
        ] {
            let (decided, known) = decision(script);
            assert_eq!(decided, known, "{script}");
        }
        assert!(register(&[]).is_err());
    }
}
