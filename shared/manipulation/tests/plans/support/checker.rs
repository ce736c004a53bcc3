//! Carries a plan out and looks at every instant whether something touches something: points on the
//! surfaces of the capsules and boxes, put where the robot description's own forward kinematics puts
//! its links. Shares no code with the planner's clearances.

use manipulation::{Cuboid, Joints, Limb, MotionLimits, ObjectPose, Phase, Robot, Timeline};
use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

use super::fixture;
use super::solid::Solid;

/// Rate at which shapes are checked, hertz.
const RATE_HZ: f64 = 100.0;

/// Overlaps that count as rounding, metres.
const TOLERANCE_M: f64 = 1e-4;

/// The same between an object and what it stood on while it is lifted off, metres.
const LIFT_TOLERANCE_M: f64 = 1e-3;

/// The checker's own table: as for the planner, solid below its top.
const TABLE_SIZE_M: [f64; 3] = [1.1, 2.4, 0.5];
const TABLE_MIDDLE_M: [f64; 2] = [0.95, 0.0];

/// A part of the robot: a solid in the frame of a link of the description.
struct Part {
    solid: Solid,
    link: usize,
    /// Pose in the frame of the link.
    origin: Isometry3<f64>,
    /// `true` if the held object may touch it.
    wrist: bool,
}

/// A solid and where it is.
type Placed<'a> = (&'a Solid, &'a Isometry3<f64>);

/// A collision found by the checker.
#[derive(Debug)]
pub(crate) struct Violation {
    pub(crate) t_s: f64,
    pub(crate) what: String,
}

/// The robot and what stands around, as the checker sees them.
pub(crate) struct Checker<'a> {
    robot: &'a Robot,
    /// The left arm's capsules, the right arm's, and what does not move.
    arms: [Vec<Part>; 2],
    body: Vec<(Solid, Isometry3<f64>)>,
    /// Numbers of an arm's capsules that must not touch.
    own_pairs: Vec<(usize, usize)>,
    /// Of an arm's capsules and of what does not move.
    body_pairs: Vec<(usize, usize)>,
}

impl<'a> Checker<'a> {
    pub(crate) fn new(robot: &'a Robot) -> Self {
        let facts: toml::Table = fixture("baxter_facts.toml").parse().unwrap();
        let capsules = facts["capsule"].as_array().unwrap();
        let arm = |limb: Limb| -> Vec<Part> {
            capsules.iter().map(|capsule| part(robot, limb, capsule)).collect()
        };
        let body = body(&facts);
        let names: Vec<&str> = body.iter().map(|(solid, _)| solid.name.as_str()).collect();
        let pairs: serde_json::Value =
            serde_json::from_str(&fixture("clearance_pairs.json")).unwrap();
        let (mut own_pairs, mut body_pairs) = (Vec::new(), Vec::new());
        for pair in pairs["pairs"].as_array().unwrap() {
            let [a, b] = [0, 1].map(|i| pair[i].as_str().unwrap());
            match (number(a, "left"), number(b, "left")) {
                (Some(a), Some(b)) => own_pairs.push((a, b)),
                (Some(a), None) => {
                    body_pairs.extend(names.iter().position(|name| *name == b).map(|b| (a, b)));
                }
                (None, Some(b)) => {
                    body_pairs.extend(names.iter().position(|name| *name == a).map(|a| (b, a)));
                }
                (None, None) => {}
            }
        }
        assert!(own_pairs.len() > 50 && body_pairs.len() > 80, "the reference's pairs");
        Self { robot, arms: [arm(Limb::Left), arm(Limb::Right)], body, own_pairs, body_pairs }
    }

    /// Returns the checker of a robot with one arm, whose description is its only source: the collision
    /// shapes, which links may touch, and what hangs on which joint.
    pub(crate) fn described(robot: &'a Robot) -> Self {
        let description = robot.description();
        let names = &robot.arm(Limb::Only).joint_names;
        let joint_of = |mut link: usize| {
            while let Some(carrier) = description.carrier(link) {
                if let Some(joint) = names.iter().position(|name| *name == carrier.name) {
                    return Some(joint);
                }
                link = carrier.parent;
            }
            None
        };
        let still = description.poses(|_| 0.0);
        let (mut arm, mut joints) = (Vec::new(), Vec::new());
        let (mut body, mut body_links) = (Vec::new(), Vec::new());
        for (index, link) in description.links().iter().enumerate() {
            for shape in &link.collision {
                let (solid, origin) = Solid::described(&link.name, shape);
                match joint_of(index) {
                    Some(joint) => {
                        let wrist = joint + 1 == names.len();
                        arm.push(Part { solid, link: index, origin, wrist });
                        joints.push(joint);
                    }
                    None => {
                        body.push((solid, still[index] * origin));
                        body_links.push(index);
                    }
                }
            }
        }
        let excused = |a: usize, b: usize| {
            description.may_touch().iter().any(|pair| *pair == (a, b) || *pair == (b, a))
        };
        let count = arm.len();
        let own_pairs = (0..count).flat_map(|i| (i + 1..count).map(move |j| (i, j)));
        let own_pairs: Vec<_> = own_pairs
            .filter(|(i, j)| joints[*j] >= joints[*i] + 2 && !excused(arm[*i].link, arm[*j].link))
            .collect();
        // The first link is mounted on the body; which others touch it, the description says.
        let loose = (0..count).filter(|i| joints[*i] >= 1);
        let body_pairs = loose
            .flat_map(|i| (0..body.len()).map(move |k| (i, k)))
            .filter(|(i, k)| !excused(arm[*i].link, body_links[*k]))
            .collect();
        assert!(own_pairs.len() > 10 && !body.is_empty(), "shapes of the description");
        Self { robot, arms: [arm, Vec::new()], body, own_pairs, body_pairs }
    }

    /// Carries `plan` out from neutral arms: `object` among `others` on a table. The first thing
    /// that goes wrong.
    pub(crate) fn violation(
        &self,
        plan: &Timeline,
        object: &ObjectPose,
        others: &[Cuboid],
        table_z_m: f64,
    ) -> Option<Violation> {
        let limb = plan.limb();
        let around = surroundings(others, table_z_m);
        let solid = Solid::cuboid("the object", object.size_m);
        let other = limb.other();
        let still = other.map(|other| self.poses(other, &self.robot.neutral()[other]).0);
        let still = still.unwrap_or_default();
        let parts = other.map_or(&[][..], |other| &self.arms[other]);
        // What stays where it is: the other arm, and what stands around.
        let parts = parts.iter().map(|part| &part.solid).zip(&still);
        let fixed: Vec<Placed<'_>> = parts.chain(around.iter().map(|(s, p)| (s, p))).collect();
        let released_s = plan.span_s(Phase::Release)?.0;
        let closed_s = plan.span_s(Phase::Close)?.1;
        let in_gripper = self.poses(limb, &plan.at(closed_s).q).1.inverse() * object.isometry();
        let steps = (plan.duration_s() * RATE_HZ).ceil() as usize;
        (0..=steps).find_map(|k| {
            let t_s = k as f64 / RATE_HZ;
            let (now, gripper) = self.poses(limb, &plan.at(t_s).q);
            let holds = t_s >= closed_s;
            let at = if holds { gripper * in_gripper } else { object.isometry() };
            let lifted = at.translation.vector - Vector3::from(object.xyz_m);
            let on_object = || {
                // The wrist and the gripper may touch what they hold.
                let arm = self.arms[limb].iter().zip(&now).filter(|(part, _)| !part.wrist);
                let arm = arm.map(|(part, pose)| ((&part.solid, pose), TOLERANCE_M));
                let body = self.body.iter().map(|(solid, pose)| (solid, pose));
                let rest = body.chain(fixed.iter().copied()).filter(|_| holds);
                let leaves = lifted.xy().norm() < 0.005 && lifted.z < 0.02;
                let tolerance_m = if leaves { LIFT_TOLERANCE_M } else { TOLERANCE_M };
                arm.chain(rest.map(|other| (other, tolerance_m)))
                    .find_map(|(other, tolerance_m)| touching((&solid, &at), other, tolerance_m))
            };
            let what = self
                .arm_touches(limb, &now, &fixed)
                .or_else(|| (t_s < released_s).then(on_object).flatten());
            what.map(|what| Violation { t_s, what })
        })
    }

    fn arm_touches(
        &self,
        limb: Limb,
        now: &[Isometry3<f64>],
        fixed: &[Placed<'_>],
    ) -> Option<String> {
        let own = |i: usize| (&self.arms[limb][i].solid, &now[i]);
        let body = |k: usize| (&self.body[k].0, &self.body[k].1);
        let with_body = self.body_pairs.iter().map(|(i, k)| (own(*i), body(*k)));
        let with_itself = self.own_pairs.iter().map(|(i, j)| (own(*i), own(*j)));
        let others = (0..now.len()).flat_map(|i| fixed.iter().map(move |other| (own(i), *other)));
        with_body.chain(with_itself).chain(others).find_map(|(a, b)| touching(a, b, TOLERANCE_M))
    }

    /// Returns the poses of one arm's capsule links and of its gripper.
    fn poses(&self, limb: Limb, q: &Joints) -> (Vec<Isometry3<f64>>, Isometry3<f64>) {
        let description = self.robot.description();
        let names = &self.robot.arm(limb).joint_names;
        let poses = description
            .poses(|joint| names.iter().position(|name| *name == joint.name).map_or(0.0, |i| q[i]));
        let gripper =
            description.link_index(&format!("{}_gripper", self.robot.arm(limb).name)).unwrap();
        (
            self.arms[limb].iter().map(|part| poses[part.link] * part.origin).collect(),
            poses[gripper],
        )
    }
}

/// Returns the first limit that a plan breaks, checked a thousand times a second.
pub(crate) fn broken_limit(plan: &Timeline, limits: &MotionLimits) -> Option<Violation> {
    let mut begin_s = 0.0;
    let mut before: Option<(Joints, Joints)> = None;
    for stage in plan.stages() {
        let steps = (stage.motion.duration_s() * 1e3).ceil() as usize;
        let mut accelerations: Option<(f64, Joints)> = None;
        for k in 0..=steps {
            let t_s = (k as f64 * 1e-3).min(stage.motion.duration_s());
            let state = stage.motion.state(t_s);
            for j in 0..7 {
                let at = |what: &str, value: f64| {
                    let what = format!("joint {j}: {what} {value}");
                    Some(Violation { t_s: begin_s + t_s, what })
                };
                let over = |value: f64, most: f64| value.abs() > most * (1.0 + 1e-6);
                let (lower, upper) = limits.position.0[j];
                if !(lower..=upper).contains(&state.q[j]) {
                    return at("position", state.q[j]);
                }
                if over(state.qd[j], limits.velocity[j]) {
                    return at("velocity", state.qd[j]);
                }
                if over(state.qdd[j], limits.acceleration[j]) {
                    return at("acceleration", state.qdd[j]);
                }
                if let Some((earlier_s, earlier)) = accelerations {
                    let change = state.qdd[j] - earlier[j];
                    if change.abs() > limits.jerk[j] * (t_s - earlier_s) + 1e-6 {
                        return at("jerk", change / (t_s - earlier_s));
                    }
                }
                if let Some((q, qd)) = before.filter(|_| k == 0)
                    && ((q[j] - state.q[j]).abs() > 1e-9 || (qd[j] - state.qd[j]).abs() > 1e-6)
                {
                    return at("jump between stages", state.q[j] - q[j]);
                }
            }
            accelerations = Some((t_s, state.qdd));
            before = Some((state.q, state.qd));
        }
        begin_s += stage.motion.duration_s();
    }
    None
}

fn touching((a, at): Placed<'_>, (b, there): Placed<'_>, tolerance_m: f64) -> Option<String> {
    let depth = a.overlap(at, b, there);
    (depth > tolerance_m).then(|| format!("{} is {:.1} mm in {}", a.name, depth * 1e3, b.name))
}

fn part(robot: &Robot, limb: Limb, capsule: &toml::Value) -> Part {
    let link = capsule["link"].as_str().unwrap();
    let triple = |key: &str| -> Vector3<f64> {
        Vector3::from(capsule[key].clone().try_into::<[f64; 3]>().unwrap())
    };
    let name = format!("{limb}_{link}");
    let radius = capsule["radius"].as_float().unwrap();
    Part {
        solid: Solid::round(&name, triple("a"), triple("b"), radius),
        link: robot.description().link_index(&name).unwrap(),
        origin: Isometry3::identity(),
        wrist: ["wrist", "hand"].contains(&link),
    }
}

/// Torso and pedestal as boxes, and the head as two balls, named as in the reference's pairs.
fn body(facts: &toml::Table) -> Vec<(Solid, Isometry3<f64>)> {
    let mut body = Vec::new();
    for link in facts["link"].as_array().unwrap() {
        let name = link["name"].as_str().unwrap();
        if !["torso", "pedestal"].contains(&name) {
            continue;
        }
        for (k, shape) in link["collision"].as_array().unwrap().iter().enumerate() {
            let triple = |key: &str| -> Option<[f64; 3]> {
                shape.get(key).and_then(|value| value.clone().try_into().ok())
            };
            if let (Some(size), Some(xyz)) = (triple("size"), triple("xyz")) {
                let solid = Solid::cuboid(&format!("{name}#{k}"), size);
                body.push((solid, Translation3::from(Vector3::from(xyz)).into()));
            }
        }
    }
    for (k, y) in [-0.04, 0.04].into_iter().enumerate() {
        let ball = Solid::round(&format!("head#{k}"), Vector3::zeros(), Vector3::zeros(), 0.22);
        body.push((ball, Isometry3::translation(0.04, y, 0.75)));
    }
    body
}

/// Returns the number of an arm's capsule in the reference, e.g. 13 of `left_hand#13`.
fn number(name: &str, limb: &str) -> Option<usize> {
    let (link, number) = name.split_once('#')?;
    link.starts_with(limb).then(|| number.parse().ok()).flatten()
}

fn surroundings(others: &[Cuboid], table_z_m: f64) -> Vec<(Solid, Isometry3<f64>)> {
    let [x, y] = TABLE_MIDDLE_M;
    let table = Isometry3::translation(x, y, table_z_m - 0.5 * TABLE_SIZE_M[2]);
    let mut around = vec![(Solid::cuboid("the table", TABLE_SIZE_M).without_points(), table)];
    for (k, other) in others.iter().enumerate() {
        let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), other.yaw);
        let place = Translation3::from(Vector3::from(other.centre));
        let solid = Solid::cuboid(&format!("object {k}"), other.size);
        around.push((solid, Isometry3::from_parts(place, turn)));
    }
    around
}
