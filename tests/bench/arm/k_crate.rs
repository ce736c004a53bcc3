//! The crate `k`, which is on an older version of our linear algebra.

use super::inverse::Solver;
use super::subject::{Subject, joints_of};
use super::{BUDGET_S, thread_s};
use dialogue::Rng;
use k::prelude::*;
use manipulation::{Joints, Limb};
use nalgebra::Isometry3;
use std::io::Write;

type Serial = k::SerialChain<f64>;

/// Distance and angle at which it stops.
const TOLERANCE: f64 = 1e-5;
/// Share of the Newton step that is taken, and steps: what does best here.
const MULTIPLIER: f64 = 0.5;
const STEPS: usize = 100;

/// One call, and calls from random postures until time is up.
pub(super) fn solvers(subject: &'static Subject) -> [Peer; 2] {
    [Peer::new(subject, false), Peer::new(subject, true)]
}

pub(super) struct Peer {
    subject: &'static Subject,
    /// In the order of the robot's limbs.
    arms: Vec<Serial>,
    solver: k::JacobianIkSolver<f64>,
    restarts: Option<Rng>,
}

/// A limb's chain from `base` to its gripper. It gets a robot of this limb alone: in a larger
/// one each joint that moves costs it a walk over all that hangs on it.
pub(super) fn chain(subject: &Subject, limb: Limb) -> Serial {
    let file = tempfile::Builder::new().suffix(".urdf").tempfile();
    let mut file = file.expect("a temporary file");
    file.write_all(description(subject, limb).as_bytes()).expect("room for a description");
    let robot = k::Chain::<f64>::from_urdf_file(file.path()).expect("a description that k reads");
    let tip = robot.find_link(&subject.tip(limb)).expect("a gripper");
    k::SerialChain::from_end(tip)
}

/// The links and joints from `base` to its gripper.
fn description(subject: &Subject, limb: Limb) -> String {
    let (robot, chain) = (subject.description(), subject.chain(limb));
    let mut text = String::from("<robot name=\"arm\">");
    for link in chain.links() {
        text += &format!("<link name=\"{}\"/>", link.name);
    }
    for joint in chain.joints() {
        let [parent, child] = [joint.parent, joint.child].map(|link| &robot.links()[link].name);
        let (p, a) = (joint.origin.translation, joint.axis);
        let (roll, pitch, yaw) = joint.origin.rotation.euler_angles();
        text += &format!(
            "<joint name=\"{}\" type=\"{}\"><parent link=\"{parent}\"/><child link=\"{child}\"/>\
             <origin xyz=\"{} {} {}\" rpy=\"{roll} {pitch} {yaw}\"/>\
             <axis xyz=\"{} {} {}\"/>",
            joint.name,
            joint.kind.name(),
            p.x,
            p.y,
            p.z,
            a.x,
            a.y,
            a.z,
        );
        if let Some(limits) = joint.limits {
            text += &format!(
                "<limit lower=\"{}\" upper=\"{}\" velocity=\"{}\" effort=\"{}\"/>",
                limits.lower, limits.upper, limits.velocity, limits.effort,
            );
        }
        text += "</joint>";
    }
    text + "</robot>"
}

impl Peer {
    fn new(subject: &'static Subject, restarting: bool) -> Self {
        Self {
            subject,
            arms: subject.limbs().iter().map(|limb| chain(subject, *limb)).collect(),
            solver: k::JacobianIkSolver::new(TOLERANCE, TOLERANCE, MULTIPLIER, STEPS),
            restarts: restarting.then(|| Rng::new(13)),
        }
    }
}

impl Solver for Peer {
    fn name(&self) -> String {
        match self.restarts {
            None => "k 0.32, one call".to_owned(),
            Some(_) => "k 0.32 with restarts, 5 ms".to_owned(),
        }
    }

    fn solve(&mut self, limb: Limb, pose: &Isometry3<f64>, seed: &Joints) -> Option<Joints> {
        let arm = &self.arms[limb.index()];
        let pose = theirs(pose);
        let started = thread_s();
        let mut from = *seed;
        loop {
            arm.set_joint_positions_clamped(self.subject.moving(limb, &from));
            if self.solver.solve(arm, &pose).is_ok() {
                return joints_of(&arm.joint_positions());
            }
            let random = self.restarts.as_mut()?;
            if thread_s() - started > BUDGET_S {
                return None;
            }
            from = self.subject.posture(limb, random);
        }
    }
}

fn theirs(pose: &Isometry3<f64>) -> k::Isometry3<f64> {
    let (p, r) = (pose.translation, pose.rotation);
    let rotation = k::nalgebra::Quaternion::new(r.w, r.i, r.j, r.k);
    k::Isometry3::from_parts(
        k::Translation3::new(p.x, p.y, p.z),
        k::UnitQuaternion::new_normalize(rotation),
    )
}

/// Forward kinematics: the tip's x.
pub(super) fn forward(arm: &Serial, q: &[f64]) -> f64 {
    arm.set_joint_positions_unchecked(q);
    arm.end_transform().translation.x
}

/// Forward kinematics and Jacobian: one of its numbers.
pub(super) fn jacobian(arm: &Serial, q: &[f64]) -> f64 {
    arm.set_joint_positions_unchecked(q);
    k::jacobian(arm)[(0, 0)]
}
