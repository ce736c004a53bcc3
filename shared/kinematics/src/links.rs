//! Every link of a limb, walked along the robot description's own joints.
//!
//! Numbers from baxter_common 1.2.0, BSD-3-Clause, Copyright (c) 2013-2015 Rethink Robotics.

#![expect(clippy::approx_constant, reason = "the description rounds π/2 and π/4 and is followed")]

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

use crate::baxter::FINGER_TRAVEL_M;
use crate::chain::positive;
use crate::limb::{Joints, Limb};

use Motion::{Fixed, Slides, Turns};

/// Pose in `base` of every link from `<limb>_arm_mount` to `<limb>_gripper` and of all that hangs
/// off it, parents first, named as in the robot description. `finger_m` in 0..=0.020833 is how
/// far each finger has opened. Quaternions have w ≥ 0.
pub fn links(limb: Limb, q: &Joints, finger_m: f64) -> Vec<(String, Isometry3<f64>)> {
    let finger_m = finger_m.clamp(0.0, FINGER_TRAVEL_M);
    let mut poses: Vec<(String, Isometry3<f64>)> = Vec::with_capacity(LINKS.len());
    for link in &LINKS {
        let origin = link.origin(limb) * link.moved(q, finger_m);
        let mut pose = match link.parent {
            Some(parent) => poses[parent].1 * origin,
            None => origin,
        };
        pose.rotation = positive(pose.rotation);
        poses.push((link.name(limb), pose));
    }
    poses
}

/// A link and the joint that carries it.
struct Link {
    name: &'static str,
    parent: Option<usize>,
    xyz: [f64; 3],
    rpy: [f64; 3],
    motion: Motion,
}

enum Motion {
    Fixed,
    /// About z, by joint `i`.
    Turns(usize),
    /// Along ±y, by the finger.
    Slides(f64),
}

impl Link {
    /// Finger links carry the limb's initial, all others its name.
    fn name(&self, limb: Limb) -> String {
        match self.name.strip_prefix("finger:") {
            Some(finger) => format!("{}_gripper_{finger}", &limb.name()[..1]),
            None => format!("{limb}_{}", self.name),
        }
    }

    /// The joint's origin in the parent; only the mount differs between the limbs.
    fn origin(&self, limb: Limb) -> Isometry3<f64> {
        let side = if self.parent.is_none() { limb.side() } else { 1.0 };
        let [x, y, z] = self.xyz;
        let [roll, pitch, yaw] = self.rpy;
        Isometry3::from_parts(
            Translation3::new(x, side * y, z),
            UnitQuaternion::from_euler_angles(roll, pitch, side * yaw),
        )
    }

    fn moved(&self, q: &Joints, finger_m: f64) -> Isometry3<f64> {
        match self.motion {
            Motion::Fixed => Isometry3::identity(),
            Motion::Turns(i) => Isometry3::rotation(Vector3::z() * q[i]),
            Motion::Slides(sign) => Isometry3::translation(0.0, sign * finger_m, 0.0),
        }
    }
}

/// The description's truncated π/2, kept so that the poses are the description's own.
const QUARTER: f64 = 1.57079632679;

const fn link(
    name: &'static str,
    parent: usize,
    xyz: [f64; 3],
    rpy: [f64; 3],
    motion: Motion,
) -> Link {
    Link { name, parent: Some(parent), xyz, rpy, motion }
}

const UP: [f64; 3] = [0.0; 3];
/// From an odd joint's frame back to one whose z runs along the arm.
const ALONG: [f64; 3] = [QUARTER, 0.0, QUARTER];
/// From a frame whose z runs along the arm to the next odd joint's.
const ACROSS: [f64; 3] = [-QUARTER, -QUARTER, 0.0];

#[rustfmt::skip]
const LINKS: [Link; 22] = [
    Link { name: "arm_mount", parent: None, xyz: [0.024645, 0.219645, 0.118588],
           rpy: [0.0, 0.0, 0.7854], motion: Fixed },
    link("upper_shoulder", 0, [0.055695, 0.0, 0.011038], UP, Turns(0)),
    link("lower_shoulder", 1, [0.069, 0.0, 0.27035], [-QUARTER, 0.0, 0.0], Turns(1)),
    link("upper_elbow", 2, [0.102, 0.0, 0.0], ALONG, Turns(2)),
    link("upper_elbow_visual", 2, [0.107, 0.0, 0.0], ALONG, Fixed),
    link("lower_elbow", 3, [0.069, 0.0, 0.26242], ACROSS, Turns(3)),
    link("upper_forearm", 5, [0.10359, 0.0, 0.0], ALONG, Turns(4)),
    link("upper_forearm_visual", 5, [0.088, 0.0, 0.0], ALONG, Fixed),
    link("arm_itb", 6, [-0.0565, 0.0, 0.12], [-QUARTER, 0.0, QUARTER], Fixed),
    link("lower_forearm", 6, [0.01, 0.0, 0.2707], ACROSS, Turns(5)),
    link("wrist", 9, [0.115975, 0.0, 0.0], ALONG, Turns(6)),
    link("hand", 10, [0.0, 0.0, 0.11355], UP, Fixed),
    link("hand_camera", 11, [0.03825, 0.012, 0.015355], [0.0, 0.0, -1.57079633], Fixed),
    link("hand_camera_axis", 11, [0.03825, 0.012, 0.015355], UP, Fixed),
    link("hand_range", 11, [0.032, -0.020245, 0.0288], [0.0, -QUARTER, -QUARTER], Fixed),
    link("hand_accelerometer", 11, [0.00198, 0.000133, -0.0146], UP, Fixed),
    link("gripper_base", 11, [0.0, 0.0, 0.025], UP, Fixed),
    link("finger:l_finger", 16, [0.0, -0.0015, 0.02], UP, Slides(1.0)),
    link("finger:l_finger_tip", 17, [0.0, 0.01725, 0.1127], UP, Fixed),
    link("finger:r_finger", 16, [0.0, 0.0015, 0.02], UP, Slides(-1.0)),
    link("finger:r_finger_tip", 19, [0.0, -0.01725, 0.1127], UP, Fixed),
    link("gripper", 16, [0.0, 0.0, 0.1327], UP, Fixed),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::{Random, arm, difference, fixture, joints, numbers, pose, table};

    #[test]
    fn poses_equal_the_reference() {
        for limb in Limb::BOTH {
            let (names, rows) = table(&format!("fk_reference_{limb}.csv"));
            // The file tells two tools apart; the description's own is the electric one.
            let columns: Vec<(usize, String)> = names
                .iter()
                .enumerate()
                .filter_map(|(at, name)| Some((at, name.strip_suffix("_x")?)))
                .filter(|(_, link)| *link != "gripper_plain")
                .map(|(at, link)| (at, link.replace("_electric", "")))
                .collect();
            assert_eq!(columns.len(), 12, "{columns:?}");
            for row in &rows {
                let row = numbers(row);
                let links = links(limb, &joints(&row[..7]), 0.0);
                for (at, link) in &columns {
                    let name = format!("{limb}_{link}");
                    let found = links.iter().find(|(n, _)| *n == name).unwrap();
                    let worst = difference(&found.1, &pose(&row[*at..at + 7]));
                    assert!(worst < 1e-9, "{name}: {worst:e}");
                }
            }
        }
    }

    #[test]
    fn names_and_parents_are_the_descriptions() {
        let urdf = fixture("baxter.urdf");
        let joints: Vec<&str> = urdf.split("<parent link=\"").skip(1).collect();
        let edges: Vec<(&str, &str)> = joints
            .iter()
            .map(|joint| {
                let child = joint.split("<child link=\"").nth(1).unwrap();
                (joint.split('"').next().unwrap(), child.split('"').next().unwrap())
            })
            .collect();
        for limb in Limb::BOTH {
            let mut expected = vec![format!("{limb}_arm_mount")];
            let mut next = 0;
            while next < expected.len() {
                let parent = expected[next].clone();
                let children = edges.iter().filter(|(p, _)| *p == parent);
                expected.extend(children.map(|(_, child)| (*child).to_owned()));
                next += 1;
            }
            let mut found: Vec<String> =
                links(limb, &[0.0; 7], 0.0).into_iter().map(|(name, _)| name).collect();
            expected.sort();
            found.sort();
            assert_eq!(found, expected);
        }
    }

    #[test]
    fn gripper_link_is_where_the_chain_says() {
        let mut random = Random::seeded(4);
        for _ in 0..200 {
            let (limb, q) = (random.limb(), random.posture());
            let links = links(limb, &q, 0.0);
            let name = format!("{limb}_gripper");
            let gripper = links.iter().find(|(n, _)| *n == name).unwrap();
            assert!(difference(&gripper.1, &arm(limb).chain.forward(&q)) < 1e-10);
        }
    }

    #[test]
    fn fingers_part_along_y() {
        let width = |finger_m| {
            let links = links(Limb::Left, &[0.0; 7], finger_m);
            let at = |name: &str| links.iter().find(|(n, _)| n == name).unwrap().1;
            let apart = at("l_gripper_l_finger_tip").inverse() * at("l_gripper_r_finger_tip");
            apart.translation.vector
        };
        let opened = width(FINGER_TRAVEL_M) - width(0.0);
        assert!((opened - Vector3::new(0.0, -2.0 * FINGER_TRAVEL_M, 0.0)).amax() < 1e-12);
        assert_eq!(width(1.0), width(FINGER_TRAVEL_M));
    }
}
