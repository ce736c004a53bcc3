//! A robot for the kinematics from its description.

use std::collections::BTreeSet;
use std::sync::{Arc, Mutex, PoisonError};

use nalgebra::{Isometry3, Point3, Vector3};
use robot_model::{Body as Shaped, Joint, JointKind, Limits, Robot as Description, Shape};

use super::fingers::gripper;
use super::{Arm, Body, Enclosure, Robot, Touch};
use crate::collision::{ArmShape, Capsule, Cuboid};
use crate::kinematics::chain::{Axis, Chain, Five, ZeroPosture};
use crate::kinematics::limb::{Joints, Limb};
use crate::kinematics::limits::{MotionLimits, PositionLimits};

/// A described robot that this crate cannot move: what is missing, and help.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{what}; help: {help}")]
pub struct Unsuitable {
    /// Missing part.
    pub what: String,
    /// Remedy.
    pub help: String,
}

/// Acceleration of joints for which the description states none, rad/s²: MoveIt's for Baxter.
const ACCELERATION_RAD_S2: f64 = 2.0;

/// Jerk of joints for which the description states none, in accelerations per second.
const JERK_PER_S: f64 = 10.0;

/// Slowest velocity, acceleration and jerk of a joint, rad/s and so on: below, motions take minutes, and checks of their
/// whole length as well. A joint without a velocity has 0.
const SLOWEST: f64 = 0.05;

/// Most collision shapes of a limb, and of the body: every check looks at all pairs.
const LIMB_SHAPES_MAX: usize = 128;
const BODY_SHAPES_MAX: usize = 512;

impl Robot {
    /// Returns the robot of a description: two limbs that end in the links `left_gripper` and
    /// `right_gripper`, or one that ends in a link `<name>_gripper`, each on five to seven turning
    /// joints. A group `<name>_arm` has a posture `neutral`, in which the limb rests; other postures
    /// of its are used as via postures where the limb is clear there.
    ///
    /// Joints without stated acceleration and jerk get 2 rad/s² and ten times that per second.
    /// Links of a limb are enclosed in capsules; the other links are the body, as it stands
    /// with every joint at zero. Opening and closed gap of a gripper are those of its fingers' shapes;
    /// a description without fingers gets Baxter's travel.
    ///
    /// # Errors
    /// [`Unsuitable`] names what is missing.
    pub fn from_description(description: &Description) -> Result<Self, Unsuitable> {
        let names = limb_names(description)?;
        let body = Arc::new(body(description, &names)?);
        let arms = match &names[..] {
            [only] => {
                let only = arm(description, Limb::Only, only, &body)?;
                [only.clone(), only]
            }
            _ => {
                let [left, right] =
                    Limb::BOTH.map(|limb| arm(description, limb, limb.name(), &body));
                [left?, right?]
            }
        };
        Ok(Self { description: Arc::new(description.clone()), arms: Arc::new(arms) })
    }
}

/// Returns the names of the limbs: what stands before `_gripper` in the links at their ends.
fn limb_names(description: &Description) -> Result<Vec<String>, Unsuitable> {
    let names: Vec<&str> = description.limb_ends().collect();
    let both = Limb::BOTH.map(Limb::name);
    if both.iter().any(|name| names.contains(name)) {
        return Ok(both.map(str::to_owned).to_vec());
    }
    match names[..] {
        [only] => Ok(vec![only.to_owned()]),
        _ => Err(Unsuitable {
            what: format!("expected one link `<limb>_gripper`, found {}", names.len()),
            help: "name the link between the fingertips arm_gripper, or left_gripper and \
                   right_gripper where there are two limbs; no other link may end in _gripper"
                .to_owned(),
        }),
    }
}

impl Chain {
    /// Returns the chain from the root to the link `tip` of any described robot; it must hang on
    /// five to seven turning joints.
    ///
    /// # Errors
    /// [`Unsuitable`] if the link is missing, or for another number of joints.
    pub fn from_description(description: &Description, tip: &str) -> Result<Self, Unsuitable> {
        let joints = joints(description, tip)?;
        let posture = posture(description, &joints, tip);
        Ok(Self::new(&posture, PositionLimits(padded(&joints, (0.0, 0.0), limits_of))))
    }
}

fn arm(
    description: &Description,
    limb: Limb,
    name: &str,
    body: &Arc<Body>,
) -> Result<Arm, Unsuitable> {
    let tip = format!("{name}_gripper");
    let joints = joints(description, &tip)?;
    joints.iter().try_for_each(|joint| fast_enough(joint))?;
    // What does not move may have any limit but zero.
    let of = |f: &dyn Fn(&Limits) -> f64| {
        padded(&joints, 1.0, |joint| joint.limits.as_ref().map_or(0.0, f))
    };
    let acceleration = |limits: &Limits| limits.acceleration.unwrap_or(ACCELERATION_RAD_S2);
    let limits = MotionLimits::new(
        PositionLimits(padded(&joints, (0.0, 0.0), limits_of)),
        of(&|limits| limits.velocity),
        of(&acceleration),
        of(&|limits| limits.jerk.unwrap_or_else(|| JERK_PER_S * acceleration(limits))),
    );
    let chain = Chain::new(&posture(description, &joints, &tip), limits.position);
    approaching(&chain, name)?;
    let enclosures = enclosures(description, name, &joints, &chain)?;
    few_enough(&format!("limb {name:?}"), enclosures.len(), LIMB_SHAPES_MAX)?;
    let touch = Touch::new(&chain, &enclosures, may_touch(description, name));
    let (pairs, loose) = (touch.pairs(), touch.loose(body));
    let mut arm = Arm {
        limb,
        name: name.to_owned(),
        joint_names: joints.iter().map(|joint| joint.name.clone()).collect(),
        pairs,
        loose,
        gripper: gripper(description, name)?,
        chain,
        limits,
        neutral: named(description, name, "neutral", &joints)?,
        via_postures: Vec::new(),
        enclosures,
        body: Arc::clone(body),
    };
    arm.via_postures = via_postures(description, &joints, &arm);
    Ok(arm)
}

/// # Errors
/// An arm of five joints does not belong to the family whose approaches can be planned.
fn approaching(chain: &Chain, name: &str) -> Result<(), Unsuitable> {
    if chain.joints() != 5 || chain.five().is_some_and(Five::approaches) {
        return Ok(());
    }
    Err(Unsuitable {
        what: format!("the five joints of limb {name:?} are no arm that can grasp"),
        help: format!(
            "an arm of five joints pans, pitches with three parallel joints, and rolls about the z axis of {name}_gripper"
        ),
    })
}

fn fast_enough(joint: &Joint) -> Result<(), Unsuitable> {
    let Some(Limits { velocity, acceleration, jerk, .. }) = joint.limits else { return Ok(()) };
    let bounds = [("velocity", Some(velocity)), ("acceleration", acceleration), ("jerk", jerk)];
    let slow =
        bounds.into_iter().find_map(|(key, bound)| Some((key, bound.filter(|it| *it < SLOWEST)?)));
    slow.map_or(Ok(()), |(key, bound)| {
        Err(Unsuitable {
            what: format!("joint {:?} has {key}={bound}, too slow to fetch anything", joint.name),
            help: format!(
                "write what the joint can do in its <limit>, {SLOWEST} or more, in radians"
            ),
        })
    })
}

/// # Errors
/// There are more collision shapes than `most`.
fn few_enough(what: &str, shapes: usize, most: usize) -> Result<(), Unsuitable> {
    if shapes <= most {
        return Ok(());
    }
    Err(Unsuitable {
        what: format!("expected at most {most} collision shapes of {what}, found {shapes}"),
        help: "enclose several in one capsule or box".to_owned(),
    })
}

/// Returns the five to seven joints that move `tip`, shoulder first.
fn joints<'a>(description: &'a Description, tip: &str) -> Result<Vec<&'a Joint>, Unsuitable> {
    let chain = description.chain(tip).map_err(|error| Unsuitable {
        what: error.to_string(),
        help: "name the link at the end of a limb of five to seven turning joints".to_owned(),
    })?;
    let joints: Vec<&Joint> = chain.movable().collect();
    let turning = joints.iter().all(|joint| joint.kind == JointKind::Revolute);
    if turning && matches!(joints.len(), 5..=7) {
        return Ok(joints);
    }
    let count = joints.len();
    Err(Unsuitable {
        what: format!(
            "link {tip:?} hangs on {count} moving joints that are not five to seven revolute ones"
        ),
        help: "limbs of five to seven revolute joints with limits are supported".to_owned(),
    })
}

/// Returns a value for each of seven joints; `none` for those that a limb does not have.
fn padded<T: Copy>(joints: &[&Joint], none: T, value: impl Fn(&Joint) -> T) -> [T; 7] {
    std::array::from_fn(|i| joints.get(i).map_or(none, |joint| value(joint)))
}

fn limits_of(joint: &Joint) -> (f64, f64) {
    joint.limits.map_or((0.0, 0.0), |limits| (limits.lower, limits.upper))
}

fn posture(description: &Description, joints: &[&Joint], tip: &str) -> ZeroPosture {
    let poses = description.poses(|_| 0.0);
    let axis = |i: usize| {
        let joint = joints[i.min(joints.len() - 1)];
        let pose = &poses[joint.child];
        let direction = pose.rotation * joint.axis.into_inner();
        Axis { point: pose.translation.vector, direction }
    };
    let tool = description.link_index(tip).map_or_else(Isometry3::identity, |link| poses[link]);
    ZeroPosture { axes: std::array::from_fn(axis), joints: joints.len(), tool }
}

fn group(limb: &str) -> String {
    format!("{limb}_arm")
}

/// A named posture of the limb; joints that it leaves out are at zero.
fn named(
    description: &Description,
    limb: &str,
    name: &str,
    joints: &[&Joint],
) -> Result<Joints, Unsuitable> {
    let group = group(limb);
    let posture = description.posture(&group, name).ok_or_else(|| Unsuitable {
        what: format!("no posture {name:?} in group {group:?}"),
        help: format!("add <group_state name={name:?} group={group:?}> to the SRDF"),
    })?;
    let position = |joint: &Joint| posture.position(joint.child - 1).unwrap_or(0.0);
    let q = padded(joints, 0.0, position);
    let outside = joints.iter().map(|joint| (joint, position(joint), limits_of(joint)));
    let mut outside = outside.filter(|(_, at, (lower, upper))| !(lower..=upper).contains(&at));
    match outside.next() {
        None => Ok(q),
        Some((joint, at, (lower, upper))) => Err(Unsuitable {
            what: format!("posture {name:?} of {group:?} has {} at {at} rad", joint.name),
            help: format!("keep it between {lower} and {upper}"),
        }),
    }
}

/// Returns the limb's named postures in which it is clear of itself and of the body.
fn via_postures(description: &Description, joints: &[&Joint], arm: &Arm) -> Vec<Joints> {
    let clear = |q: &Joints| {
        let shape = ArmShape::at(arm, q);
        !shape.to_itself(0.0).is_some() && !shape.to_trunk(0.0).is_some()
    };
    let of_limb = description.postures().iter().filter(|posture| posture.group == group(&arm.name));
    let named = of_limb.filter_map(|own| named(description, &arm.name, &own.name, joints).ok());
    named.filter(clear).collect()
}

/// Returns the last of the limb's joints that moves a link.
fn mover(description: &Description, joints: &[&Joint], mut link: usize) -> Option<usize> {
    while let Some(joint) = description.carrier(link) {
        if let Some(place) = joints.iter().position(|own| own.child == joint.child) {
            return Some(place);
        }
        link = joint.parent;
    }
    None
}

/// Returns the capsules round the limb's links, each in the frame of the joint that moves it.
fn enclosures(
    description: &Description,
    limb: &str,
    joints: &[&Joint],
    chain: &Chain,
) -> Result<Vec<Enclosure>, Unsuitable> {
    // An open jaw takes more room than a closed one.
    let jaw = description.jaw(limb);
    let open =
        |joint: &Joint| jaw.filter(|jaw| jaw.link == joint.child).map_or(0.0, |jaw| jaw.open_rad());
    let poses = description.poses(open);
    let frames = chain.frames(&[0.0; 7]);
    let mut enclosures = Vec::new();
    for (index, link) in description.links().iter().enumerate() {
        let Some(joint) = mover(description, joints, index) else { continue };
        let local = |p: Vector3<f64>| frames[joint].seen(&(p - frames[joint].origin));
        for shaped in &link.collision {
            let Capsule { a, b, radius } = enclosing(shaped, &poses[index], &link.name)?;
            let capsule = Capsule { a: local(a), b: local(b), radius };
            enclosures.push(Enclosure { joint, link: kept(short(limb, &link.name)), capsule });
        }
    }
    Ok(enclosures)
}

/// Shapes of the body.
fn body(description: &Description, names: &[String]) -> Result<Body, Unsuitable> {
    let limbs = names.iter().map(|name| joints(description, &format!("{name}_gripper")));
    let limbs = limbs.collect::<Result<Vec<_>, _>>()?;
    let poses = description.poses(|_| 0.0);
    let mut body = Body::default();
    for (index, link) in description.links().iter().enumerate() {
        if limbs.iter().any(|joints| mover(description, joints, index).is_some()) {
            continue;
        }
        for shaped in &link.collision {
            let name = kept(&link.name);
            let pose = poses[index] * shaped.origin;
            match shaped.shape {
                Shape::Box { size } => body.cuboids.push((name, upright(&pose, &size))),
                _ => body.capsules.push((name, enclosing(shaped, &poses[index], &link.name)?)),
            }
        }
    }
    few_enough("the body", body.cuboids.len() + body.capsules.len(), BODY_SHAPES_MAX)?;
    Ok(body)
}

/// Returns the upright box round a box: the box itself if it stands upright.
fn upright(pose: &Isometry3<f64>, size: &Vector3<f64>) -> Cuboid {
    let rotation = pose.rotation.to_rotation_matrix();
    let z = rotation.matrix().column(2);
    if z[2] > 1.0 - 1e-9 {
        let x = rotation.matrix().column(0);
        let yaw = x[1].atan2(x[0]);
        return Cuboid { centre: pose.translation.vector.into(), size: (*size).into(), yaw };
    }
    let extent = rotation.matrix().abs() * size;
    Cuboid::aligned(pose.translation.vector.into(), extent.into())
}

/// Returns the capsule round a shape, in the root's frame at `link`'s pose. Round shapes keep their
/// size.
fn enclosing(shaped: &Shaped, link: &Isometry3<f64>, name: &str) -> Result<Capsule, Unsuitable> {
    let pose = link * shaped.origin;
    let along = |axis: Vector3<f64>, length: f64, radius: f64| {
        let end = |sign: f64| (pose * Point3::from(axis * (0.5 * sign * length))).coords;
        Capsule { a: end(-1.0), b: end(1.0), radius }
    };
    match &shaped.shape {
        Shape::Capsule { radius, length } | Shape::Cylinder { radius, length } => {
            Ok(along(Vector3::z(), *length, *radius))
        }
        Shape::Sphere { radius } => Ok(along(Vector3::z(), 0.0, *radius)),
        Shape::Box { size } => {
            let longest = size.imax();
            let mut axis = Vector3::zeros();
            axis[longest] = 1.0;
            let aside = 0.5 * (size.norm_squared() - size[longest] * size[longest]).sqrt();
            Ok(along(axis, size[longest], aside))
        }
        Shape::Mesh { file } => Err(Unsuitable {
            what: format!("link {name:?} has a mesh ({file}) for its collision shape"),
            help: "enclose it in capsules, cylinders, boxes or spheres instead".to_owned(),
        }),
    }
}

fn may_touch(description: &Description, limb: &str) -> Vec<(String, String)> {
    let name = |link: usize| short(limb, &description.links()[link].name).to_owned();
    description.may_touch().iter().map(|(a, b)| (name(*a), name(*b))).collect()
}

/// Returns a link's name without its limb's.
fn short<'a>(limb: &str, name: &'a str) -> &'a str {
    name.strip_prefix(limb).and_then(|rest| rest.strip_prefix('_')).unwrap_or(name)
}

/// Returns the name for as long as the program runs: a program knows few robots, and errors that
/// name a link are copied about.
fn kept(name: &str) -> &'static str {
    static NAMES: Mutex<BTreeSet<&'static str>> = Mutex::new(BTreeSet::new());
    let mut names = NAMES.lock().unwrap_or_else(PoisonError::into_inner);
    match names.get(name) {
        Some(known) => known,
        None => {
            let name: &'static str = String::from(name).leak();
            names.insert(name);
            name
        }
    }
}
