//! The dialogue: belief about the wanted object, and decisions about the next act.
//!
//! This crate is pure: no IO, no clock, no threads. Its results depend on the arguments alone, so
//! that a replay believes and decides the same, bit for bit on the same build.
//!
//! # Example
//!
//! Two markers that differ in colour: the robot asks, hears "yes", and picks.
//!
//! ```
//! use dialogue::{Belief, DecisionProblem, Model, Step, registry};
//! use scene::{Question, Reading, Response, Scene};
//! use vocabulary::{Action, Actions, Costs, Mode, Params};
//!
//! let scene = Scene::from_json(
//!     "markers",
//!     &serde_json::json!({
//!         "objects": [
//!             { "name": "left", "attributes": { "color": "red" } },
//!             { "name": "right", "attributes": { "color": "blue" } },
//!         ],
//!         "values": { "color": ["red", "blue"] },
//!     }),
//! )?;
//! let model = Model::new(&scene, Params::default());
//! let actions = Actions { mode: Mode::Remote, attribute: true, which: false, choice: false };
//! let problem = DecisionProblem::new(&model, Costs::default(), actions);
//! let mut planner = registry::planner("lookahead")?;
//!
//! let mut belief = Belief::uniform(2);
//! let decision = planner.decide(&problem, &belief, Step::default());
//! let Action::Ask(question @ Question::Attribute(..)) = decision.action else { panic!("{decision:?}") };
//!
//! // Equations (6) and (7): the answer is wrong with probability 0.01.
//! belief.update(&model, question, &Reading { response: Response::Yes, ..Reading::default() });
//! assert!((belief.probability(0.into()) - 0.99).abs() < 1e-9);
//!
//! let decision = planner.decide(&problem, &belief, Step { interaction: 1, step: 1 });
//! assert_eq!(decision.action, Action::Pick(0.into()));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod answer;
mod answer_attribution;
mod belief;
mod concessions;
mod confusion;
mod decision;
mod evaluate;
mod gesture;
mod lesson;
pub mod manager;
mod model;
mod observation;
mod planner;
mod planners;
mod planning;
mod policy_table;
mod posterior;
pub mod registry;
pub mod rendering;
mod speaker;
mod stable_hash;
pub mod user_model;
mod value_evidence;

#[cfg(test)]
mod testing;

pub use answer::Answer;
pub use answer_attribution::{Candidate, Shares};
pub use belief::{Belief, BeliefError};
pub use concessions::Concessions;
pub use confusion::{Confusion, NotAConfusion};
pub use decision::Decision;
pub use evaluate::{Evaluation, evaluate};
pub use lesson::{Count, Lesson};
pub use model::{CERTAIN_SMOOTHING, Model};
pub use observation::{CERTAIN_DOUBT, Naming, log_likelihood};
pub use planner::{DecisionProblem, Planner, Step};
pub use planners::{Lookahead, Optimal};
pub use policy_table::PolicyTable;
pub use posterior::Posterior;
pub use speaker::{Channel, Speaker};
pub use value_evidence::ValueLikelihoods;
