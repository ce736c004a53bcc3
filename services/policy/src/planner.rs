//! The policy service with a planner from outside this repository.
//!
//! ```no_run
//! use dialogue::registry::{self, Entry};
//! use dialogue::{Belief, Decision, DecisionProblem, Planner, Step};
//! use vocabulary::Action;
//! use std::process::ExitCode;
//!
//! /// Asks as `entropy` does until an object has 80 %.
//! struct Hasty(Box<dyn Planner + Send>);
//!
//! impl Planner for Hasty {
//!     fn name(&self) -> &'static str {
//!         "hasty"
//!     }
//!
//!     fn decide(&mut self, problem: &DecisionProblem<'_>, belief: &Belief, step: Step) -> Decision {
//!         let decision = self.0.decide(problem, belief, step);
//!         let likeliest = belief.most_likely();
//!         match belief.probability(likeliest) {
//!             p if p >= 0.8 => Decision { action: Action::Pick(likeliest), ..decision },
//!             _ => decision,
//!         }
//!     }
//! }
//!
//! fn main() -> ExitCode {
//!     let make = || Box::new(Hasty(registry::planner("entropy").expect("a planner"))) as _;
//!     policy::planner::run(Entry { name: "hasty", about: "Picks at 80 %.", make })
//! }
//! ```
//!
//! The configuration names the program, which also verifies the journals that it has written:
//!
//! ```toml
//! [services.policy]
//! command = ["/opt/lab/hasty", "--planner", "hasty"]
//! ```

use std::process::ExitCode;

use dialogue::registry::{self, Entry};
use service::exit::{Exit, Failure};

use service::service_loop::Program;

use crate::shell::PolicyProgram;

/// Runs the policy service, or an inspection of its journal, with this planner in addition to the
/// shipped ones. `--planner NAME` chooses it. Returns the exit code.
pub fn run(planner: Entry) -> ExitCode {
    if let Err(error) = registry::add(planner) {
        let add = |_| Err(Failure::new(Exit::Invariant, error.to_string()));
        return service::service_loop::program("policy", PolicyProgram::ABOUT, add);
    }
    service::service_loop::run::<PolicyProgram>()
}
