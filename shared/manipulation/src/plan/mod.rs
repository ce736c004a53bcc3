//! Motions with a purpose: fetching an object, pointing at one, going home.

mod check;
mod choices;
mod deliver;
mod error;
mod fetch;
mod furniture;
mod pick;
mod point;
mod posture;
mod situation;
#[cfg(test)]
mod tests;

pub use check::check_reachable;
pub use deliver::{plan_delivery, plan_return};
pub use error::PlanError;
pub(crate) use furniture::Obstacle;
pub use pick::{PickPhase, PickPlan, plan_pick};
pub use point::{PointPhase, PointPlan, plan_point};
pub use situation::{Arms, PlanSettings};
