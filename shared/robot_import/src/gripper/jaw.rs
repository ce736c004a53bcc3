//! A gripper of one jaw that turns, from the shapes of the jaw and of the finger that does not move.

use nalgebra::{Isometry3, Translation3, Vector3};
use robot_model::{Jaw, JointKind};

use super::{FORCE_N, Gripper, Hulls, OPENING_MIN_M, TIP_M, axes, frame, reach, solid};
use crate::report::Findings;
use crate::source::Source;
use crate::structure::Arm;

/// A jaw that turns.
#[derive(Clone, Debug)]
pub(crate) struct Turning {
    /// Its joint in the file.
    pub(crate) joint: usize,
    /// Its tip in the frame of its link, with the gripper's axes.
    pub(crate) tip: Isometry3<f64>,
    /// Breadth of the fingertips, metres.
    pub(crate) breadth_m: f64,
    /// Torque of the joint for [`FORCE_N`] at the tip, Nm.
    pub(crate) torque_nm: f64,
    /// Position of every joint with the gripper closed.
    pub(crate) closed: Vec<f64>,
}

/// Points of a part within [`TIP_M`] of its end, and where along z that is.
fn ends(parts: &[crate::points::Hull], z: &Vector3<f64>) -> Option<(Vec<Vector3<f64>>, f64)> {
    let end = parts.iter().map(|it| it.extent(z).1).reduce(f64::max)?;
    let near = parts.iter().flat_map(|it| &it.points).filter(|at| at.dot(z) > end - TIP_M);
    Some((near.copied().collect(), end))
}

fn extent(points: &[Vector3<f64>], axis: &Vector3<f64>) -> (f64, f64) {
    let along = points.iter().map(|at| at.dot(axis));
    along.fold((f64::MAX, f64::MIN), |(a, b), at| (a.min(at), b.max(at)))
}

/// The hand and its jaw, in the frame of the arm's last link.
struct Hand<'a> {
    source: &'a Source,
    arm: &'a Arm,
    hulls: &'a Hulls,
    /// The joint of the jaw.
    leader: usize,
    to_last: Isometry3<f64>,
}

impl Hand<'_> {
    /// Positions of every joint with the jaw at an angle.
    fn q(&self, angle: f64) -> Vec<f64> {
        let mut q = self.source.zeros();
        q[self.leader] = angle;
        q
    }

    fn link(&self) -> usize {
        self.source.joints[self.leader].child
    }

    /// The pose of the jaw at an angle.
    fn jaw(&self, angle: f64) -> Isometry3<f64> {
        self.to_last * self.source.poses(&self.q(angle))[self.link()]
    }

    /// Points of the jaw at its tip.
    fn tip(&self, angle: f64, z: &Vector3<f64>) -> Option<Vec<Vector3<f64>>> {
        let poses = self.source.poses(&self.q(angle));
        let all = solid(self.source, self.hulls, &self.to_last, &poses, self.link());
        ends(&all.collect::<Vec<_>>(), z).map(|(points, _)| points)
    }

    /// Returns the frame at the tip of the finger that does not move, and how broad the finger is there.
    fn finger(&self) -> Option<(Isometry3<f64>, f64)> {
        let joint = &self.source.joints[self.leader];
        let zero = self.source.poses(&self.q(joint.zero()));
        let all = solid(self.source, self.hulls, &self.to_last, &zero, self.arm.hand);
        let reach = reach(self.source, self.arm, &zero, &[joint.child], self.hulls);
        let (y, z) = axes(self.source, self.arm, joint, &zero, &reach);
        let (fixed, end) = ends(&all.collect::<Vec<_>>(), &z)?;
        let middle = |points: &[Vector3<f64>], axis: &Vector3<f64>| {
            let (low, high) = extent(points, axis);
            0.5 * (low + high)
        };
        let side = middle(&self.tip(joint.zero(), &z)?, &y) - middle(&fixed, &y);
        let y = if side < 0.0 { -y } else { y };
        let x = y.cross(&z);
        let (low, high) = extent(&fixed, &x);
        let origin = x * middle(&fixed, &x) + y * extent(&fixed, &y).1 + z * end;
        Some((frame(origin, &y, &z), (high - low).clamp(0.006, 0.03)))
    }

    /// Returns the jaw's innermost point at its tip where it is closed, in its own link's frame, and the angle.
    fn innermost(&self, frame: &Isometry3<f64>, limits: (f64, f64)) -> Option<(Vector3<f64>, f64)> {
        let (y, z) = (frame.rotation * Vector3::y(), frame.rotation * Vector3::z());
        let at = |angle: f64| {
            let tip = self.tip(angle, &z)?.into_iter();
            tip.min_by(|a, b| a.dot(&y).total_cmp(&b.dot(&y))).map(|it| (it, angle))
        };
        let both = [limits.0, limits.1].into_iter().filter_map(at);
        let (inner, angle) = both.min_by(|a, b| a.0.dot(&y).total_cmp(&b.0.dot(&y)))?;
        Some((self.jaw(angle).inverse_transform_point(&inner.into()).coords, angle))
    }
}

/// Returns the gripper if it is one jaw on a turning joint, and the meshes show it and the finger.
pub(super) fn find(
    source: &Source,
    arm: &Arm,
    leader: usize,
    hulls: &Hulls,
    findings: &mut Findings,
) -> Option<Gripper> {
    let joint = &source.joints[leader];
    let limits =
        joint.range.filter(|_| arm.fingers.len() == 1 && joint.kind == JointKind::Revolute)?;
    let to_last = source.poses(&source.zeros())[arm.last].inverse();
    let hand = Hand { source, arm, hulls, leader, to_last };
    let (frame, breadth_m) = hand.finger()?;
    let (inner, closed_rad) = hand.innermost(&frame, limits)?;
    let zero = frame.inverse() * hand.jaw(0.0);
    let (pivot, tip) = (zero.translation.vector, zero * nalgebra::Point3::from(inner));
    let axis = zero.rotation * joint.axis.into_inner();
    let jaw = Jaw::new(joint.child, [pivot.y, pivot.z], [tip.y, tip.z], axis.x.signum(), limits);
    let (closed_m, open_m) = jaw.ends_m();
    if axis.x.abs() < 0.99 || open_m - closed_m.max(0.0) < OPENING_MIN_M {
        return None;
    }
    tell(&joint.name, &jaw, findings);
    let turned = hand.jaw(joint.zero()).rotation.inverse() * frame.rotation;
    Some(Gripper {
        frame,
        closed_m: closed_m.max(0.0),
        open_m,
        force_n: FORCE_N,
        open: hand.q(jaw.open_rad()),
        is_drawn: false,
        jaw: Some(Turning {
            joint: leader,
            tip: Isometry3::from_parts(Translation3::from(inner), turned),
            breadth_m,
            torque_nm: FORCE_N * jaw.radius_m(),
            closed: hand.q(closed_rad),
        }),
    })
}

fn tell(joint: &str, jaw: &Jaw, findings: &mut Findings) {
    let (closed_m, open_m) = jaw.ends_m();
    let (radius_mm, closed_mm, open_mm) =
        (jaw.radius_m() * 1e3, closed_m.max(0.0) * 1e3, open_m * 1e3);
    findings.chosen(format!(
        "gripper: one turning jaw, {joint}, whose tip moves on an arc of {radius_mm:.0} mm about its axis and stands \
         {closed_mm:.0} to {open_mm:.0} mm from the finger that does not move"
    ));
    findings.assumed(format!("the jaw presses with {FORCE_N:.0} N: the file does not say"));
}
