//! Kinematics of the shipped robots.

use manipulation::{Chain, Joints, Limb, Robot};
use robot_model::Robot as Description;
use std::hint::black_box;

/// Postures whose poses are asked for.
const POSTURES: usize = 50;

/// Postures all over the joints' ranges (the fractional parts of multiples of square roots).
fn postures(chain: &Chain) -> Vec<Joints> {
    let roots = [2.0_f64, 3.0, 5.0, 7.0, 11.0, 13.0, 17.0].map(f64::sqrt);
    let share = |n: usize| roots.map(|root| (root * (n + 1) as f64).fract());
    (0..POSTURES).map(|n| chain.limits().at(&share(n))).collect()
}

fn inverse(chain: &Chain, times: u32) {
    let poses: Vec<_> = postures(chain).iter().map(|q| chain.forward(q)).collect();
    for pose in poses.iter().cycle().take(times as usize) {
        black_box(chain.inverse(black_box(pose), None).expect("the pose of a posture"));
    }
}

pub(crate) fn baxter(times: u32) {
    inverse(&Robot::baxter().arm(Limb::Left).chain, times);
}

pub(crate) fn ur5e(times: u32) {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../config/robots/ur5e");
    let read = |ext| std::fs::read_to_string(format!("{folder}.{ext}")).expect("a readable file");
    let description = Description::parse(&read("urdf"), Some(&read("srdf"))).expect("a robot");
    let robot = Robot::from_description(&description).expect("a robot with one arm");
    inverse(&robot.arm(Limb::Only).chain, times);
}

pub(crate) fn jacobian(times: u32) {
    let chain = &Robot::baxter().arm(Limb::Left).chain;
    for q in postures(chain).iter().cycle().take(times as usize) {
        black_box(chain.tool_and_jacobian(black_box(q)));
    }
}
