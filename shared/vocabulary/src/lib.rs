//! The vocabulary of the group: identifiers, moments, acts, phases and outcomes, questions as they
//! were put, readings, and the plain settings of the dialogue.
//!
//! This crate is pure, and plans nothing: almost every crate depends on it, and changes of planners
//! or reader rebuild few. `dialogue` computes with these types: its searches call the functions
//! marked `#[inline]` millions of times, and a release is linked without optimisation.

mod action;
mod announce;
mod attribution;
mod costs;
mod durations;
pub mod gesture;
pub mod ids;
mod interaction;
mod interpretation;
mod language;
pub mod named;
mod params;
mod person;
mod planners;
mod presentation;
mod prior;
pub mod reaction;
mod rng;
mod table;
pub mod time;
mod turn_taking;
pub mod wall_time;

pub use action::{Action, Actions, Mode};
pub use announce::Announce;
pub use attribution::{Attributed, Attribution, QuestionShare};
pub use costs::Costs;
pub use durations::Durations;
pub use interaction::{ActKind, Ended, Outcome, PickOutcome, PickPhase, RESUME_AFTER, Task};
pub use interpretation::{Interpretation, NamedReading};
pub use language::Language;
pub use params::{Fault, Params, Reliability};
pub use person::{Acquaintance, NotAPerson, PERSON_BYTES_MAX, PersonId};
pub use planners::PLANNERS;
pub use presentation::{NamedQuestion, Presentation};
pub use prior::{Prior, PriorObjects};
pub use rng::Rng;
pub use table::{TABLE_MAX, Table};
pub use turn_taking::TurnTaking;
