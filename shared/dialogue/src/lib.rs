//! The dialogue: what an utterance says about the wanted object, and what to do next.
//!
//! This crate is pure: no IO, no clock, no threads. What it computes depends on its arguments
//! alone, so that a replay believes and decides the same, bit for bit on the same build.
//!
//! # Example
//!
//! Two markers that differ in colour: the robot asks, hears "yes", and picks.
//!
//! ```
//! use dialogue::{Action, Actions, Belief, Costs, DecisionProblem, Mode, Model, Params, Step, registry};
//! use scene::{Question, Reading, Response, Scene};
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
//! let actions = Actions { mode: Mode::Remote, attribute: true, which: false };
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

mod action;
mod announce;
mod answer;
mod answer_attribution;
mod belief;
mod concessions;
mod confusion;
mod costs;
mod durations;
mod evaluate;
pub mod export;
pub mod gesture;
pub mod ids;
mod interaction;
mod interpretation;
mod learned;
pub mod manager;
mod model;
mod model_user;
mod observation;
mod params;
mod planner;
mod planners;
mod planning;
mod policy_table;
mod posterior;
mod presentation;
mod prior;
pub mod registry;
pub mod rendering;
mod rng;
mod stable_hash;
mod table;
pub mod time;
mod turn_taking;
pub mod user_model;
pub mod wall_time;

#[cfg(test)]
mod testing;

pub use action::{Action, Actions, Decision, Mode};
pub use announce::Announce;

pub use answer::Answer;
pub use answer_attribution::{Attributed, Attribution, Candidate, QuestionShare, Shares};
pub use belief::{Belief, BeliefError};
pub use concessions::Concessions;
pub use confusion::{Confusion, NotAConfusion};
pub use costs::Costs;
pub use durations::Durations;
pub use evaluate::{Evaluation, evaluate};
pub use interaction::{ActKind, Ended, Outcome, PickOutcome, PickPhase, Task};
pub use interpretation::{Interpretation, NamedReading};
pub use model::Model;
pub use model_user::ModelUser;
pub use observation::{CERTAIN_DOUBT, OpenQuestion, log_likelihood};
pub use params::{Fault, Params};
pub use planner::{DecisionProblem, Planner, Step};
pub use planners::{Lookahead, Optimal};
pub use policy_table::PolicyTable;
pub use posterior::Posterior;
pub use presentation::{NamedQuestion, Presentation};
pub use prior::{Prior, PriorObjects};
pub use rng::Rng;
pub use table::{TABLE_MAX, Table};
pub use turn_taking::TurnTaking;
