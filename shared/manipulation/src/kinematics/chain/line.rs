//! Straight lines of the gripper, followed without leaving the branch of solutions.

use nalgebra::Isometry3;

use crate::kinematics::chain::Chain;
use crate::kinematics::limb::Joints;

/// Gripper travel from one waypoint of a line to the next, metres.
const STEP_M: f64 = 0.005;

/// The same for turning in place, radians.
const STEP_RAD: f64 = 0.02;

/// The most that a joint may turn from one waypoint to the next, radians. A larger change is a
/// flip through a singularity, not a motion along the line.
const JUMP_RAD: f64 = 0.15;

/// A straight line that cannot be followed.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("the straight line ends {:.0} % of the way: {}", fraction * 100.0, if *jumps {
    "the arm would have to flip"
} else {
    "a joint is at its limit"
})]
pub struct LineError {
    /// Share of the line that can be followed, 0 to 1.
    pub fraction: f64,
    /// The last posture on it, radians.
    pub q: Joints,
    /// `true` if the next posture was too far rather than out of reach.
    pub jumps: bool,
}

impl Chain {
    /// Joint waypoints that take the gripper from where it is at `q` to `target` in a straight
    /// line, turning evenly: `q` first, then one every 5 mm or 0.02 rad, each within the limits
    /// and within [`crate::TOLERANCE_M`] of the line.
    ///
    /// # Errors
    /// [`LineError`] where the line leaves the limits or the branch of solutions.
    pub fn line(&self, q: &Joints, target: &Isometry3<f64>) -> Result<Vec<Joints>, LineError> {
        let start = self.forward(q);
        let travel = (target.translation.vector - start.translation.vector).norm() / STEP_M;
        let turn = start.rotation.angle_to(&target.rotation) / STEP_RAD;
        let steps = travel.max(turn).ceil().max(1.0) as usize;
        let mut waypoints = Vec::with_capacity(steps + 1);
        waypoints.push(*q);
        let mut last = *q;
        for k in 1..=steps {
            let pose = between(&start, target, k as f64 / steps as f64);
            let fraction = (k - 1) as f64 / steps as f64;
            let next = self
                .track(&pose, &last)
                .map_err(|_| LineError { fraction, q: last, jumps: false })?
                .q;
            if last.iter().zip(&next).any(|(a, b)| (a - b).abs() > JUMP_RAD) {
                return Err(LineError { fraction, q: last, jumps: true });
            }
            waypoints.push(next);
            last = next;
        }
        Ok(waypoints)
    }
}

/// Returns the pose at a share of the way, positions and rotations each at constant rate.
fn between(from: &Isometry3<f64>, to: &Isometry3<f64>, share: f64) -> Isometry3<f64> {
    let rotation = from.rotation.try_slerp(&to.rotation, share, 1e-9).unwrap_or(if share < 1.0 {
        from.rotation
    } else {
        to.rotation
    });
    let translation = from.translation.vector.lerp(&to.translation.vector, share);
    Isometry3::from_parts(translation.into(), rotation)
}

#[cfg(test)]
mod tests {
    use nalgebra::Translation3;

    use crate::TOLERANCE_M;
    use crate::kinematics::limb::Limb;
    use crate::samples::{arm, full, neutral};

    #[test]
    fn a_line_is_straight_and_even() {
        let chain = arm(Limb::Left).chain;
        let start = chain.forward(&neutral());
        let target = Translation3::new(0.05, -0.1, 0.12) * start;
        let line = chain.line(&neutral(), &target).unwrap();
        assert_eq!(line[0], neutral());
        assert_eq!(line.len(), 34, "164 mm in steps of at most 5 mm, and the start");
        let way = target.translation.vector - start.translation.vector;
        for (k, q) in line.iter().enumerate() {
            assert!(full().position.within(q));
            let pose = chain.forward(q);
            let share = k as f64 / (line.len() - 1) as f64;
            let off = pose.translation.vector - start.translation.vector - way * share;
            assert!(off.norm() <= TOLERANCE_M, "{k}: {off:?}");
            assert!(pose.rotation.angle_to(&start.rotation) < 1e-6);
        }
    }

    #[test]
    fn a_line_may_turn_in_place() {
        let chain = arm(Limb::Right).chain;
        let start = chain.forward(&neutral());
        let target = start * nalgebra::Isometry3::rotation(nalgebra::Vector3::z() * 0.49);
        let line = chain.line(&neutral(), &target).unwrap();
        assert_eq!(line.len(), 26);
        let end = chain.forward(&line[25]);
        assert!(end.rotation.angle_to(&target.rotation) < 1e-6);
    }

    #[test]
    fn a_line_out_of_reach_says_how_far_it_goes() {
        let chain = arm(Limb::Left).chain;
        let target = Translation3::new(0.0, 0.0, 2.0) * chain.forward(&neutral());
        let error = chain.line(&neutral(), &target).unwrap_err();
        assert!(error.fraction > 0.02 && error.fraction < 0.8, "{error}");
        assert!(full().position.within(&error.q));
        assert!(error.to_string().contains("straight line ends"));
    }
}
