//! The gripper: its frame, its opening, and how its fingers move.

mod jaw;

use nalgebra::{Isometry3, Rotation3, Translation3, UnitQuaternion, Vector3};
use robot_model::JointKind;

use crate::points::Hull;
use crate::report::Findings;
use crate::source::{Joint, Source};
use crate::structure::Arm;

/// Opening and force where the description has none: of a common two-finger gripper.
const OPEN_M: f64 = 0.05;
pub(super) const FORCE_N: f64 = 20.0;

/// Length of a gripper that is assumed on a flange, and of fingers without meshes, metres.
pub(crate) const LENGTH_M: f64 = 0.12;
const FINGER_M: f64 = 0.05;
const JAW_M: f64 = 0.08;

/// Shapes within this of the fingertips face each other, metres.
pub(super) const TIP_M: f64 = 0.015;

/// Least opening that makes a gripper, metres.
pub(super) const OPENING_MIN_M: f64 = 0.012;

/// Length from which on links that are fixed to the last one are a hand, metres.
const HAND_M: f64 = 0.06;

/// A gripper at the end of an arm.
#[derive(Clone, Debug)]
pub(crate) struct Gripper {
    /// Its frame in the last link's: origin between the fingertips, z out of the fingers, y along their travel.
    pub(crate) frame: Isometry3<f64>,
    /// Distance of the fingertips, closed and open, metres.
    pub(crate) closed_m: f64,
    pub(crate) open_m: f64,
    /// Force of each finger, newtons.
    pub(crate) force_n: f64,
    /// Position of each joint of the description with the gripper open.
    pub(crate) open: Vec<f64>,
    /// Whether a gripper of [`LENGTH_M`] is drawn on the flange.
    pub(crate) is_drawn: bool,
    /// The jaw that turns, of a gripper whose other finger does not move.
    pub(crate) jaw: Option<Turning>,
}

pub(crate) use jaw::Turning;

/// Length of fingers without meshes, metres. The jaw of a small arm turns about an axis at its wrist.
fn assumed_m(arm: &Arm) -> f64 {
    if arm.fingers.len() == 1 && arm.joints.len() == 5 { JAW_M } else { FINGER_M }
}

/// What the parts of the robot look like.
pub(crate) type Hulls = [Vec<Hull>];

/// Finds the gripper of an arm; `open_m` overrides its opening.
pub(crate) fn find(
    source: &Source,
    arm: &Arm,
    hulls: &Hulls,
    open_m: Option<f64>,
    findings: &mut Findings,
) -> Gripper {
    let leader = leading(source, arm);
    if let Some(gripper) = leader.and_then(|joint| jaw::find(source, arm, joint, hulls, findings)) {
        if open_m.is_some() {
            findings
                .ignored("--opening-mm: how far a jaw opens follows from its shape and its joint");
        }
        return gripper;
    }
    let mut gripper = match leader {
        Some(leader) => fingers(source, arm, leader, hulls, findings),
        None => without_fingers(source, arm, hulls, findings),
    };
    if let Some(open_m) = open_m {
        findings.chosen(format!("opening of the gripper: {:.0} mm, as asked", open_m * 1e3));
        (gripper.closed_m, gripper.open_m) = (gripper.closed_m.min(0.2 * open_m), open_m);
    }
    gripper
}

/// The joint that drives the fingers: the first that follows no other.
fn leading(source: &Source, arm: &Arm) -> Option<usize> {
    arm.fingers.iter().copied().find(|joint| source.joints[*joint].follows.is_none())
}

/// Positions of all joints with the gripper at one end of its range: every joint of it that follows none moves by the same
/// share of its range.
fn at_end(source: &Source, arm: &Arm, upper: bool) -> Vec<f64> {
    let mut q = source.zeros();
    for joint in &arm.fingers {
        let (low, high) = source.joints[*joint].span();
        q[*joint] = if upper { high } else { low };
    }
    q
}

fn fingers(
    source: &Source,
    arm: &Arm,
    leader: usize,
    hulls: &Hulls,
    findings: &mut Findings,
) -> Gripper {
    let joint = &source.joints[leader];
    let slides = joint.kind == JointKind::Prismatic;
    let tips = tips(source, arm);
    let poses = source.poses(&at_end(source, arm, true));
    let (y, z) = axes(source, arm, joint, &poses, &reach(source, arm, &poses, &tips, hulls));
    let ends = [false, true].map(|upper| {
        let q = at_end(source, arm, upper);
        (gap(source, arm, &q, &tips, hulls, (&y, &z)), q)
    });
    let [(one, q_one), (other, q_other)] = ends;
    let travel = if slides { travel(source, arm) } else { 0.0 };
    let (closed_m, open_m) = opening(one.zip(other), travel, findings);
    let open = if one.unwrap_or(0.0) > other.unwrap_or(1.0) { q_one } else { q_other };
    let kind = kind(source, arm);
    findings.chosen(format!(
        "gripper: {kind} on {}, which opens {:.0} to {:.0} mm",
        source.links[arm.hand].name,
        closed_m.max(0.0) * 1e3,
        open_m * 1e3
    ));
    let tip = tip(source, arm, &source.poses(&open), &tips, hulls, (&y, &z));
    if tip.1 {
        findings.assumed(format!(
            "the fingers are {:.0} mm long: their meshes are missing",
            assumed_m(arm) * 1e3
        ));
    }
    Gripper {
        frame: frame(tip.0, &y, &z),
        closed_m: closed_m.max(0.0),
        open_m,
        force_n: force(joint, findings),
        open,
        is_drawn: false,
        jaw: None,
    }
}

/// Returns the axes y and z of the gripper: the travel of its fingers, and out of them, in the last link's frame.
fn axes(
    source: &Source,
    arm: &Arm,
    joint: &Joint,
    poses: &[Isometry3<f64>],
    reach: &Vector3<f64>,
) -> (Vector3<f64>, Vector3<f64>) {
    let to_last = poses[arm.last].inverse();
    let axis = to_last.rotation * poses[joint.child].rotation * joint.axis.into_inner();
    // The fingers reach away from the hand, at right angles to the axis of their joints.
    let hand = (to_last * poses[arm.hand]).translation.vector;
    let out = (reach - hand) - axis * (reach - hand).dot(&axis);
    let z = out.try_normalize(1e-4).unwrap_or_else(|| outwards(source, arm, poses));
    // An arm of five joints approaches along its last one.
    let z = if arm.joints.len() == 5 { outwards(source, arm, poses) } else { snapped(z, &axis) };
    let y = if joint.kind == JointKind::Prismatic { axis } else { axis.cross(&z) };
    ((y - z * y.dot(&z)).normalize(), z)
}

/// Returns the travel of all fingers together, metres.
fn travel(source: &Source, arm: &Arm) -> f64 {
    let of = |joint: &usize| {
        let joint = &source.joints[*joint];
        let (low, high) = joint.follows.map_or(joint.span(), |rule| {
            let (low, high) = source.joints[rule.joint].span();
            (rule.factor * low, rule.factor * high)
        });
        (high - low).abs()
    };
    arm.fingers.iter().map(of).sum()
}

/// Returns the distance of closed and of open fingers: as measured between their shapes, else by their travel.
fn opening(measured: Option<(f64, f64)>, travel: f64, findings: &mut Findings) -> (f64, f64) {
    let ends = measured.map(|(a, b)| (a.min(b), a.max(b)));
    let is_believable =
        |(low, high): &(f64, f64)| high - low.max(0.0) >= OPENING_MIN_M && *high < 0.4;
    if let Some(ends) = ends.filter(is_believable) {
        return ends;
    }
    if travel >= OPENING_MIN_M {
        let mm = travel * 1e3;
        findings
            .assumed(format!("the fingers close entirely: they open by their travel, {mm:.0} mm"));
        return (0.0, travel);
    }
    let mm = OPEN_M * 1e3;
    findings
        .assumed(format!("the gripper opens {mm:.0} mm: its shapes do not say; --opening-mm N"));
    (0.0, OPEN_M)
}

/// Returns the force of a finger, newtons: the effort of its joint, if that is a force.
fn force(joint: &Joint, findings: &mut Findings) -> f64 {
    let slides = joint.kind == JointKind::Prismatic;
    let force = joint.effort.filter(|effort| slides && (1.0..500.0).contains(effort));
    force.unwrap_or_else(|| {
        findings.assumed(format!("each finger presses with {FORCE_N:.0} N: the file does not say"));
        FORCE_N
    })
}

fn kind(source: &Source, arm: &Arm) -> String {
    let count = arm.fingers.len();
    let coupled = arm.fingers.iter().filter(|it| source.joints[**it].follows.is_some()).count();
    let sliding =
        arm.fingers.iter().filter(|it| source.joints[**it].kind == JointKind::Prismatic).count();
    match (count, sliding) {
        (1, 0) => "one turning jaw".to_owned(),
        (1, _) => "one sliding finger".to_owned(),
        (_, sliding) if sliding == count => format!("{count} sliding fingers, {coupled} coupled"),
        _ => format!("a linkage of {count} joints, {coupled} coupled"),
    }
}

/// Links at the ends of the fingers.
fn tips(source: &Source, arm: &Arm) -> Vec<usize> {
    let links = arm.fingers.iter().map(|joint| source.joints[*joint].child);
    let has_more = |link: usize| {
        arm.fingers.iter().any(|joint| {
            let parent = source.joints[*joint].parent;
            parent != arm.hand && source.is_below(parent, link)
        })
    };
    links.filter(|link| !has_more(*link)).collect()
}

/// Hulls of a link and of what is fixed to it, in the last link's frame.
fn solid<'a>(
    source: &'a Source,
    hulls: &'a Hulls,
    to_last: &'a Isometry3<f64>,
    poses: &'a [Isometry3<f64>],
    link: usize,
) -> impl Iterator<Item = Hull> + 'a {
    let own = (0..source.links.len()).filter(move |other| is_fixed_to(source, *other, link));
    own.flat_map(move |own| hulls[own].iter().map(move |hull| hull.at(&(to_last * poses[own]))))
}

fn is_fixed_to(source: &Source, mut link: usize, top: usize) -> bool {
    while link != top {
        match source.links[link].carrier.map(|carrier| &source.joints[carrier]) {
            Some(joint) if joint.kind == JointKind::Fixed => link = joint.parent,
            _ => return false,
        }
    }
    true
}

/// Returns the middle of the fingers.
fn reach(
    source: &Source,
    arm: &Arm,
    poses: &[Isometry3<f64>],
    tips: &[usize],
    hulls: &Hulls,
) -> Vector3<f64> {
    let to_last = poses[arm.last].inverse();
    let middles = tips.iter().map(|link| {
        let shapes: Vec<Hull> = solid(source, hulls, &to_last, poses, *link).collect();
        let origin = (to_last * poses[*link]).translation.vector;
        let count = shapes.len() as f64;
        if shapes.is_empty() {
            origin
        } else {
            shapes.iter().map(|it| it.centre).sum::<Vector3<f64>>() / count
        }
    });
    middles.sum::<Vector3<f64>>() / tips.len().max(1) as f64
}

/// Returns the axis of the last link's frame that a direction all but has, or else the direction.
fn snapped(z: Vector3<f64>, across: &Vector3<f64>) -> Vector3<f64> {
    let axes = (0..3).flat_map(|i| [Vector3::ith(i, 1.0), Vector3::ith(i, -1.0)]);
    let near = axes.into_iter().find(|axis| axis.dot(&z) > 0.9 && axis.dot(across).abs() < 1e-3);
    near.unwrap_or(z)
}

/// The direction in which the last joint's axis leads away from the arm, in the last link's frame.
fn outwards(source: &Source, arm: &Arm, poses: &[Isometry3<f64>]) -> Vector3<f64> {
    let joint = &source.joints[arm.joints[arm.joints.len() - 1]];
    let axis = joint.axis.into_inner();
    let to_last = poses[arm.last].inverse();
    let ends = (0..source.links.len()).filter(|link| is_fixed_to(source, *link, arm.last));
    let ahead: f64 = ends.map(|link| (to_last * poses[link]).translation.vector.dot(&axis)).sum();
    // A flange is ahead of the joint, or the joint is ahead of the one before it.
    let before = arm.joints.len().checked_sub(3).map(|at| source.joints[arm.joints[at]].child);
    let behind = before.map_or(0.0, |link| -(to_last * poses[link]).translation.vector.dot(&axis));
    let sense = if ahead.abs() > 1e-3 { ahead } else { behind };
    if sense < -1e-6 { -axis } else { axis }
}

/// Returns the free distance between the fingers at their tips.
fn gap(
    source: &Source,
    arm: &Arm,
    q: &[f64],
    tips: &[usize],
    hulls: &Hulls,
    (y, z): (&Vector3<f64>, &Vector3<f64>),
) -> Option<f64> {
    let poses = source.poses(q);
    let to_last = poses[arm.last].inverse();
    let mut sides: Vec<Vec<Hull>> =
        tips.iter().map(|link| solid(source, hulls, &to_last, &poses, *link).collect()).collect();
    if sides.len() == 1 {
        // One jaw closes on what does not move.
        sides.push(solid(source, hulls, &to_last, &poses, arm.hand).collect());
    }
    let end = |side: &Vec<Hull>| side.iter().map(|it| it.extent(z).1).fold(f64::MIN, f64::max);
    let top = sides.iter().filter(|side| !side.is_empty()).map(end).fold(f64::MAX, f64::min);
    let extents = sides.iter().filter_map(|side| {
        let near = side.iter().flat_map(|it| &it.points).filter(|at| at.dot(z) > top - TIP_M);
        let along = near.map(|at| at.dot(y));
        let ends = along.fold((f64::MAX, f64::MIN), |(a, b), at| (a.min(at), b.max(at)));
        (ends.0 <= ends.1).then_some(ends)
    });
    let mut extents: Vec<(f64, f64)> = extents.collect();
    extents.sort_by(|a, b| (a.0 + a.1).total_cmp(&(b.0 + b.1)));
    match &extents[..] {
        [low, .., high] => Some(high.0 - low.1),
        _ => None,
    }
}

/// Returns the point between the fingertips, and whether their length is assumed.
fn tip(
    source: &Source,
    arm: &Arm,
    poses: &[Isometry3<f64>],
    tips: &[usize],
    hulls: &Hulls,
    (y, z): (&Vector3<f64>, &Vector3<f64>),
) -> (Vector3<f64>, bool) {
    let to_last = poses[arm.last].inverse();
    let mut shapes: Vec<Hull> =
        tips.iter().flat_map(|link| solid(source, hulls, &to_last, poses, *link)).collect();
    // Of a small arm without meshes the hand is a guess, and no longer than its wrist.
    if tips.len() == 1 && !(arm.joints.len() == 5 && shapes.is_empty()) {
        shapes.extend(solid(source, hulls, &to_last, poses, arm.hand));
    }
    let middle = reach(source, arm, poses, tips, hulls);
    let x = y.cross(z);
    if shapes.is_empty() {
        let base = (to_last * poses[arm.hand]).translation.vector;
        let end = middle.dot(z).max(base.dot(z)) + assumed_m(arm);
        return (x * middle.dot(&x) + y * base.dot(y) + z * end, true);
    }
    let end = shapes.iter().map(|it| it.extent(z).1).fold(f64::MIN, f64::max);
    let near: Vec<&Vector3<f64>> =
        shapes.iter().flat_map(|it| &it.points).filter(|at| at.dot(z) > end - TIP_M).collect();
    let middle_of = |axis: &Vector3<f64>| {
        let ends = near.iter().map(|at| at.dot(axis));
        let ends = ends.fold((f64::MAX, f64::MIN), |(a, b), at| (a.min(at), b.max(at)));
        0.5 * (ends.0 + ends.1)
    };
    (x * middle_of(&x) + y * middle_of(y) + z * end, false)
}

fn frame(origin: Vector3<f64>, y: &Vector3<f64>, z: &Vector3<f64>) -> Isometry3<f64> {
    let turn = Rotation3::from_basis_unchecked(&[y.cross(z), *y, *z]);
    Isometry3::from_parts(Translation3::from(origin), UnitQuaternion::from_rotation_matrix(&turn))
}

/// Returns a gripper for an arm without fingers: on its flange, or at the end of a hand that does not move.
fn without_fingers(source: &Source, arm: &Arm, hulls: &Hulls, findings: &mut Findings) -> Gripper {
    let open = source.zeros();
    let poses = source.poses(&open);
    let z = outwards(source, arm, &poses);
    let to_last = poses[arm.last].inverse();
    let fixed = (0..source.links.len()).filter(|link| is_fixed_to(source, *link, arm.last));
    let fixed: Vec<usize> = fixed.collect();
    let ends = fixed.iter().map(|link| (to_last * poses[*link]).translation.vector);
    let flange = ends.map(|at| at.dot(&z)).fold(0.0, f64::max);
    let shapes: Vec<Hull> = solid(source, hulls, &to_last, &poses, arm.last).collect();
    let solid_end = shapes.iter().map(|it| it.extent(&z).1).fold(flange, f64::max);
    // Parts behind the last link that are as long as a hand are one.
    let parts = fixed.iter().filter(|link| **link != arm.last).flat_map(|link| {
        hulls[*link].iter().map(|hull| hull.at(&(to_last * poses[*link])).extent(&z))
    });
    let ends = parts.fold((f64::MAX, f64::MIN), |(a, b), (low, high)| (a.min(low), b.max(high)));
    let is_hand = ends.1 - ends.0 > HAND_M;
    let end = if is_hand { solid_end } else { solid_end + LENGTH_M };
    let across = Vector3::ith(z.iamin(), 1.0);
    let y = (across - z * across.dot(&z)).normalize();
    findings.assumed(format!(
        "gripper: no joint moves a finger, so two fingers that open {:.0} mm and press with {FORCE_N:.0} N are assumed {}",
        OPEN_M * 1e3,
        if is_hand { "at the end of the hand" } else { "120 mm ahead of the flange" }
    ));
    findings.missing(
        "the gripper: describe it in the file, or state its opening with --opening-mm N".to_owned(),
    );
    Gripper {
        frame: frame(z * end, &y, &z),
        closed_m: 0.0,
        open_m: OPEN_M,
        force_n: FORCE_N,
        open,
        is_drawn: !is_hand,
        jaw: None,
    }
}
