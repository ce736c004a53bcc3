//! `whichone plan`: what the robot does at a belief.

use std::io::Read;
use std::time::Instant;

use dialogue::{Action, Belief, DecisionProblem, Model, Planner, Step};
use scene::{Scene, question_to_json};
use serde::Deserialize;
use serde_json::{Value as Json, json};

use super::{parse, run};
use crate::Outcome;
use crate::output::Output;

/// A planner with one scene's decision problem.
pub struct Decider {
    /// The scene.
    pub scene: Scene,
    /// What the observation model needs of it.
    pub model: Model,
    /// What actions cost.
    pub costs: dialogue::Costs,
    /// What each question costs, where that was measured.
    pub durations: Option<dialogue::Durations>,
    /// What the robot may do.
    pub actions: dialogue::Actions,
    /// What decides.
    pub planner: Box<dyn Planner + Send>,
}

#[derive(Deserialize)]
struct Line {
    #[serde(default)]
    id: Json,
    belief: Vec<f64>,
}

/// Answers each belief with `{"id","action","value","micros"}`.
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
        let Self { model, costs, durations, actions, planner, .. } = self;
        let durations = durations.as_ref();
        let problem = DecisionProblem { model, costs: *costs, actions: *actions, durations };
        planner.prepare(&problem, &Belief::uniform(problem.model.hypotheses()));
    }

    fn answer(&mut self, line: Line) -> Result<Json, String> {
        let objects = self.scene.objects().len();
        if line.belief.len() != objects {
            let given = line.belief.len();
            return Err(format!("belief: {given} probabilities for {objects} objects"));
        }
        let belief = Belief::from_probabilities(&line.belief).map_err(|e| e.to_string())?;
        let Self { model, costs, durations, actions, planner, .. } = self;
        let durations = durations.as_ref();
        let problem = DecisionProblem { model, costs: *costs, actions: *actions, durations };
        let started = Instant::now();
        let decision = planner.decide(&problem, &belief, Step::default());
        let micros = started.elapsed().as_secs_f64() * 1e6;
        let action = action_to_json(&self.scene, decision.action);
        Ok(json!({ "id": line.id, "action": action, "value": decision.value, "micros": micros }))
    }
}

fn action_to_json(scene: &Scene, action: Action) -> Json {
    match action {
        Action::Wait => json!({ "type": "wait" }),
        Action::Ask(question) => question_to_json(scene, question),
        Action::Pick(object) => json!({ "type": "pick", "object": scene.object(object).name }),
    }
}
