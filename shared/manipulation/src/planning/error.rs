//! Errors of planning.

use crate::collision::Gap;
use crate::kinematics::chain::LineError;
use crate::kinematics::limb::Limb;
use crate::planning::fetch::HOME;
use crate::planning::grasp::GraspError;
use crate::trajectory::TrajectoryError;

/// A failed plan: the error of the attempt that came furthest. Nothing moves.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum PlanError {
    /// The object cannot be held.
    #[error("it cannot be grasped: {0}")]
    Grasp(#[from] GraspError),
    /// The arm stands outside its joint limits.
    #[error("the arm cannot start: {0}")]
    Start(#[from] TrajectoryError),
    /// No posture within the limits takes the gripper there.
    #[error("{at} is out of the {limb} arm's reach by {:.0} mm", distance_m * 1e3)]
    Unreachable {
        /// Goal of the motion, e.g. `the place above the object`.
        at: &'static str,
        /// The arm that came nearest.
        limb: Limb,
        /// Distance from the goal at the nearest posture, metres.
        distance_m: f64,
    },
    /// A place that an arm of five joints reaches, but not from straight above, nor with a tilt that holds.
    #[error(
        "the {limb} arm, of five joints, cannot approach {at} from above: {off_deg:.0} degrees off at best"
    )]
    Approach {
        /// Goal of the motion.
        at: &'static str,
        /// The arm.
        limb: Limb,
        /// Least angle between its approach and straight down, degrees.
        off_deg: f64,
    },
    /// Reachable, but not in the straight line that is needed.
    #[error("the {limb} arm cannot go straight to {at}: {line}")]
    Line {
        /// Goal of the line.
        at: &'static str,
        /// The arm.
        limb: Limb,
        /// Point of failure.
        line: LineError,
    },
    /// The arm would touch something there.
    #[error(
        "at {at} the {limb} arm's {} would be {:.0} mm from the {}",
        gap.link, gap.distance_m * 1e3, gap.other
    )]
    Blocked {
        /// Place, e.g. `the grasp`.
        at: &'static str,
        /// The arm.
        limb: Limb,
        /// Colliding shapes; a negative distance is an overlap.
        gap: Gap,
    },
    /// The limb stands in collision and no motion leads out of it.
    #[error(
        "the {limb} arm stands in collision: its {} is {:.0} mm from the {}; help: move the arm \
         clear by hand",
        gap.link, gap.distance_m * 1e3, gap.other
    )]
    Stuck {
        /// The arm.
        limb: Limb,
        /// Colliding shapes; a negative distance is an overlap.
        gap: Gap,
    },
    /// Both ends are clear, but no path between them was found.
    #[error("no way for the {limb} arm to {at} was found that touches nothing{}", in_way(gap))]
    NoPath {
        /// Goal of the path.
        at: &'static str,
        /// The arm.
        limb: Limb,
        /// Obstacle on the straight path.
        gap: Option<Gap>,
    },
}

impl PlanError {
    /// Whether the limb touches something in the posture in which it rests, whatever it is to fetch.
    pub fn is_at_rest(&self) -> bool {
        matches!(self, Self::Blocked { at: HOME, .. })
    }
}

fn in_way(gap: &Option<Gap>) -> String {
    gap.map_or_else(String::new, |gap| {
        format!("; straight there its {} would meet the {}", gap.link, gap.other)
    })
}

/// Keeps the error of the attempt that came furthest.
#[derive(Default)]
pub(crate) struct Furthest {
    worst: Option<(usize, PlanError)>,
}

impl Furthest {
    /// Remembers an error of an attempt that had `progress` behind it.
    pub(crate) fn add(&mut self, progress: usize, error: PlanError) {
        let further = match &self.worst {
            None => true,
            Some((before, other)) => {
                progress > *before || progress == *before && nearer(&error, other)
            }
        };
        if further {
            self.worst = Some((progress, error));
        }
    }

    /// Returns the error to report.
    ///
    /// # Panics
    /// If no error was added.
    pub(crate) fn report(self) -> PlanError {
        self.worst.expect("a plan is refused for a reason").1
    }
}

/// Of two errors at the same stage, whether `a` missed by less than `b`.
fn nearer(a: &PlanError, b: &PlanError) -> bool {
    match (a, b) {
        (
            PlanError::Unreachable { distance_m: a, .. },
            PlanError::Unreachable { distance_m: b, .. },
        ) => a < b,
        (PlanError::Blocked { gap: a, .. }, PlanError::Blocked { gap: b, .. }) => {
            a.distance_m > b.distance_m
        }
        _ => false,
    }
}
