//! `whichone plan`: the robot's next action at a belief.

use std::io::Read;
use std::time::Instant;

use command_line::Outcome;
use command_line::output::Output;
use config::Settings;
use dialogue::{Belief, DecisionProblem, Model, Planner, Step};
use scene::{Scene, question_to_json};
use serde::Deserialize;
use serde_json::{Value as Json, json};
use vocabulary::{Action, Actions, Announce, Costs, Durations};

use super::{parse, run};

/// A scene's decision problem, with the data that it borrows.
pub struct Problem {
    /// The scene.
    pub scene: Scene,
    /// Observation model of the scene.
    pub model: Model,
    /// Costs of actions and rewards of picks.
    pub costs: Costs,
    /// Costs of the questions by the robot's durations, if these are used.
    pub durations: Option<Durations>,
    /// Actions that are allowed.
    pub actions: Actions,
    /// Whether an announced pick can be denied.
    pub announce: Announce,
    /// Settings of the configuration, if there is one.
    pub settings: Option<Settings>,
}

impl Problem {
    /// Returns the decision problem for planners.
    pub fn decision(&self) -> DecisionProblem<'_> {
        let problem = DecisionProblem::new(&self.model, self.costs, self.actions);
        DecisionProblem { durations: self.durations.as_ref(), announce: self.announce, ..problem }
    }
}

/// A planner with one scene's decision problem.
pub struct Decider {
    /// The problem.
    pub problem: Problem,
    /// The planner.
    pub planner: Box<dyn Planner + Send>,
}

#[derive(Deserialize)]
struct Line {
    #[serde(default)]
    id: Json,
    belief: Vec<f64>,
}

/// Answers each belief with `{"id","action","value","micros"}`, and the planner's `bounds` if an
/// announced pick can be denied.
///
/// # Errors
/// See [`run`].
pub fn plan(decider: &mut Decider, input: impl Read, out: &mut Output<'_>) -> Outcome {
    decider.prepare();
    run(input, out, |line| decider.answer(parse(line)?))
}

impl Decider {
    /// Lets the planner work ahead, as the policy service does before it is ready.
    fn prepare(&mut self) {
        let problem = self.problem.decision();
        self.planner.prepare(&problem, &Belief::uniform(problem.model.hypotheses()));
    }

    fn answer(&mut self, line: Line) -> Result<Json, String> {
        let objects = self.problem.scene.objects().len();
        if line.belief.len() != objects {
            let given = scene::count(line.belief.len(), "probability");
            return Err(format!("belief: {given} for {}", scene::count(objects, "object")));
        }
        let belief = Belief::from_probabilities(&line.belief).map_err(|e| e.to_string())?;
        let started = Instant::now();
        let decision = self.planner.decide(&self.problem.decision(), &belief, Step::default());
        let micros = started.elapsed().as_secs_f64() * 1e6;
        let action = action_to_json(&self.problem.scene, decision.action);
        let mut answer =
            json!({ "id": line.id, "action": action, "value": decision.value, "micros": micros });
        if let (false, Some(bounds)) = (self.problem.announce.is_final(), decision.bounds) {
            answer["bounds"] = json!(bounds);
        }
        Ok(answer)
    }
}

fn action_to_json(scene: &Scene, action: Action) -> Json {
    match action {
        Action::Wait => json!({ "type": "wait" }),
        Action::Ask(question) => question_to_json(scene, question),
        Action::Pick(object) => json!({ "type": "pick", "object": scene.object(object).name }),
    }
}
