//! Plans with a purpose: fetching an object, putting it back, pointing at one, returning to rest.

mod choices;
mod deliver;
mod error;
mod fetch;
pub(crate) mod grasp;
mod held_object;
mod pick;
mod planning_scene;
mod point;
mod posture;
mod put_back;
mod retreat;
mod static_obstacles;
mod tilt;

pub use deliver::{plan_delivery, plan_return, plan_withdrawal};
pub use error::PlanError;
pub use grasp::{Grasp, GraspError, ObjectPose};
pub use pick::{check_reachable, fetching_limb, plan_pick};
pub use planning_scene::PlanSettings;
pub use point::plan_point;
pub use put_back::{plan_put_back, plan_put_down};
pub use retreat::{OUTSIDE_MAX_RAD, plan_retreat};
pub(crate) use static_obstacles::Obstacle;
