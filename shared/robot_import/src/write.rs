//! The description as whichone reads it: URDF and SRDF.

use std::collections::HashSet;
use std::fmt::Write;

use nalgebra::{Isometry3, Vector3};
use robot_model::JointKind;

use crate::gripper::Gripper;
use crate::pairs::{Pair, Pairs};
use crate::report::Findings;
use crate::shapes::Shape;
use crate::source::Source;
use crate::structure::Arm;

/// Name of the limb; the link between its fingertips is `arm_gripper`.
pub(crate) const LIMB: &str = "arm";

/// Velocity of joints that the file gives none, rad/s, and of fingers, m/s.
const VELOCITY: f64 = 1.0;
const FINGER_M_S: f64 = 0.1;
/// Torque of joints that the file gives none, Nm.
const EFFORT: f64 = 10.0;
/// A joint of the arm is at least as fast as that, rad/s.
const SLOWEST: f64 = 0.05;

/// Parts of a robot between reading and writing.
pub(crate) struct Import<'a> {
    pub(crate) name: &'a str,
    pub(crate) file: &'a str,
    pub(crate) source: &'a Source,
    pub(crate) arm: &'a Arm,
    pub(crate) gripper: &'a Gripper,
    pub(crate) names: Names,
    pub(crate) bounds: Vec<Bounds>,
    /// Shapes of each link, in its frame.
    pub(crate) shapes: Vec<Vec<Shape>>,
    /// Poses of the links at rest: lifts in their middle, the gripper open, the rest at zero.
    pub(crate) rest: Vec<Isometry3<f64>>,
    /// Frame base in the root's.
    pub(crate) mount: Isometry3<f64>,
    pub(crate) pairs: Pairs,
    /// Pairs that may touch only since their shapes are wider than the links.
    pub(crate) fat: Vec<Pair>,
}

/// Names of links and joints in the files that are written.
#[derive(Clone, Debug, Default)]
pub(crate) struct Names {
    pub(crate) links: Vec<String>,
    joints: Vec<String>,
    fingers: [String; 2],
}

impl Names {
    /// Keeps every name that means nothing else here.
    pub(crate) fn new(import: &Import<'_>, findings: &mut Findings) -> Self {
        let source = import.source;
        let mut taken: HashSet<String> =
            ["base", "arm_gripper", "arm_jaw", "arm_finger_1", "arm_finger_2"]
                .map(str::to_owned)
                .into();
        let mut links = Vec::new();
        for link in &source.links {
            let mut name = link.name.clone();
            // Such names are those of grippers here.
            if name.ends_with("_gripper") {
                name += "_link";
            }
            while taken.contains(&name) {
                name += "_1";
            }
            if name != link.name {
                findings.chosen(format!(
                    "link {} is called {name}, since its name has a meaning here",
                    link.name
                ));
            }
            taken.insert(name.clone());
            links.push(name);
        }
        let sliding: Vec<usize> = import
            .arm
            .fingers
            .iter()
            .copied()
            .filter(|joint| source.joints[*joint].kind == JointKind::Prismatic)
            .collect();
        let own = |at: usize| source.joints[sliding[at]].name.clone();
        let fingers = match sliding.len() {
            2 => [own(0), own(1)],
            _ => ["finger_1_joint", "finger_2_joint"].map(|name| unused(source, name)),
        };
        let joints = source.joints.iter().map(|joint| match fingers.contains(&joint.name) {
            true => unused(source, &format!("{}_mount", joint.name)),
            false => joint.name.clone(),
        });
        Self { links, joints: joints.collect(), fingers }
    }
}

fn unused(source: &crate::source::Source, name: &str) -> String {
    let mut name = name.to_owned();
    while source.joints.iter().any(|joint| joint.name == name) {
        name += "_joint";
    }
    name
}

/// Position limits and so on of a joint of the arm, as they are written.
pub(crate) struct Bounds {
    pub(crate) range: (f64, f64),
    velocity: f64,
    effort: f64,
}

/// Returns the bounds of a joint of the arm; what is missing or impossible is assumed.
pub(crate) fn bounds(joint: &crate::source::Joint, findings: &mut Findings) -> Bounds {
    use std::f64::consts::{PI, TAU};
    let name = &joint.name;
    let range = match (joint.kind, joint.range) {
        (JointKind::Continuous, _) => {
            findings.assumed(format!(
                "joint {name} turns without end: it is limited to one turn to either side"
            ));
            (-TAU, TAU)
        }
        (_, Some((low, high))) if high - low > 1e-3 => {
            let cut = (low.max(-TAU), high.min(TAU));
            if (cut.0 - low).max(high - cut.1) > 1e-6 && cut.1 > cut.0 {
                findings.assumed(format!("joint {name} is limited to one turn to either side, instead of {low} to {high} rad"));
                cut
            } else {
                cut
            }
        }
        _ => {
            findings.assumed(format!(
                "joint {name} has no limits of its position: half a turn to either side"
            ));
            findings.missing(format!("lower and upper of joint {name}"));
            (-PI, PI)
        }
    };
    let velocity = joint.velocity.filter(|it| *it >= SLOWEST).unwrap_or_else(|| {
        findings.assumed(format!("joint {name} has no velocity to speak of: {VELOCITY} rad/s"));
        findings.missing(format!("velocity of joint {name}"));
        VELOCITY
    });
    let effort = joint.effort.filter(|it| *it > 0.0).unwrap_or_else(|| {
        findings.assumed(format!("joint {name} has no effort: {EFFORT} Nm"));
        EFFORT
    });
    Bounds { range, velocity, effort }
}

/// Returns the URDF.
pub(crate) fn urdf(import: &Import<'_>) -> String {
    let mut out = String::from("<?xml version=\"1.0\"?>\n");
    line(
        &mut out,
        format_args!("<!-- Written by `whichone robot import` from {}.", comment(import.file)),
    );
    line(
        &mut out,
        format_args!(
            "     Frame base: x ahead, z up; metres, radians, newtons. Shapes enclose the links' convex hulls. -->"
        ),
    );
    line(&mut out, format_args!("<robot name=\"{}\">", import.name));
    line(
        &mut out,
        format_args!("  <material name=\"arm\"><color rgba=\"0.72 0.73 0.75 1\"/></material>"),
    );
    line(&mut out, format_args!("  <link name=\"base\"/>"));
    let source = import.source;
    for (index, link) in source.links.iter().enumerate() {
        match link.carrier {
            None => {
                joint(
                    &mut out,
                    "base_mount",
                    "fixed",
                    "base",
                    &import.names.links[index],
                    &import.mount.inverse(),
                );
                line(&mut out, format_args!("  </joint>"));
            }
            Some(carrier) => carried(&mut out, import, carrier),
        }
        body(&mut out, &import.names.links[index], &import.shapes[index]);
    }
    gripper(&mut out, import);
    out.push_str("</robot>\n");
    out
}

fn line(out: &mut String, text: std::fmt::Arguments<'_>) {
    // Writing to a string does not fail.
    let _ = writeln!(out, "{text}");
}

/// Text within a comment of XML.
fn comment(text: &str) -> String {
    text.replace("--", "- -")
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;")
}

fn numbers(vector: &Vector3<f64>) -> String {
    // Ten digits: links of a metre are right to less than an atom.
    let of = |part: f64| format!("{}", (part * 1e10).round() / 1e10 + 0.0);
    format!("{} {} {}", of(vector.x), of(vector.y), of(vector.z))
}

fn origin(pose: &Isometry3<f64>) -> String {
    let (roll, pitch, yaw) = pose.rotation.euler_angles();
    let (xyz, rpy) = (&pose.translation.vector, Vector3::new(roll, pitch, yaw));
    format!("<origin xyz=\"{}\" rpy=\"{}\"/>", numbers(xyz), numbers(&rpy))
}

fn joint(out: &mut String, name: &str, kind: &str, parent: &str, child: &str, at: &Isometry3<f64>) {
    let [name, parent, child] = [name, parent, child].map(escaped);
    line(out, format_args!("  <joint name=\"{name}\" type=\"{kind}\">"));
    line(out, format_args!("    <parent link=\"{parent}\"/><child link=\"{child}\"/>"));
    line(out, format_args!("    {}", origin(at)));
}

/// Writes a joint of the file: those of the arm move, the others stand still.
fn carried(out: &mut String, import: &Import<'_>, carrier: usize) {
    let own = &import.source.joints[carrier];
    let name = &import.names.joints[carrier];
    let (parent, child) = (&import.names.links[own.parent], &import.names.links[own.child]);
    if let Some(jaw) = import.gripper.jaw.as_ref().filter(|jaw| jaw.joint == carrier) {
        let ((low, high), velocity) =
            (own.span(), own.velocity.filter(|it| *it > 0.0).unwrap_or(VELOCITY));
        let effort = (jaw.torque_nm * 1e3).round() / 1e3;
        return turning(out, (name, parent, child), own, ((low, high), velocity, effort));
    }
    let Some(at) = import.arm.joints.iter().position(|joint| *joint == carrier) else {
        // In the file's posture of rest, with open fingers.
        let pose = import.rest[own.parent].inverse() * import.rest[own.child];
        joint(out, name, "fixed", parent, child, &pose);
        return line(out, format_args!("  </joint>"));
    };
    let Bounds { range, velocity, effort } = &import.bounds[at];
    turning(out, (name, parent, child), own, (*range, *velocity, *effort));
}

/// Writes a turning joint of the file by the names of itself, its parent and its child, with its bounds: position,
/// velocity and effort.
fn turning(
    out: &mut String,
    (name, parent, child): (&str, &str, &str),
    own: &crate::source::Joint,
    ((low, high), velocity, effort): ((f64, f64), f64, f64),
) {
    joint(out, name, "revolute", parent, child, &own.origin);
    line(out, format_args!("    <axis xyz=\"{}\"/>", numbers(&own.axis)));
    line(
        out,
        format_args!(
            "    <limit lower=\"{low}\" upper=\"{high}\" velocity=\"{velocity}\" effort=\"{effort}\"/>"
        ),
    );
    line(out, format_args!("  </joint>"));
}

fn body(out: &mut String, name: &str, shapes: &[Shape]) {
    let name = escaped(name);
    if shapes.is_empty() {
        return line(out, format_args!("  <link name=\"{name}\"/>"));
    }
    line(out, format_args!("  <link name=\"{name}\">"));
    for shape in shapes {
        let (pose, geometry) = geometry(shape);
        let inner = format!("{}<geometry>{geometry}</geometry>", origin(&pose));
        line(out, format_args!("    <visual>{inner}<material name=\"arm\"/></visual>"));
        line(out, format_args!("    <collision>{inner}</collision>"));
    }
    line(out, format_args!("  </link>"));
}

/// Rounds lengths up to a tenth of a millimetre, so that nothing is left out.
fn up(m: f64) -> f64 {
    (m * 1e4).ceil() / 1e4
}

fn geometry(shape: &Shape) -> (Isometry3<f64>, String) {
    match shape {
        Shape::Box { pose, size } => (*pose, format!("<box size=\"{}\"/>", numbers(&size.map(up)))),
        Shape::Capsule(capsule) => {
            let (pose, length) = capsule.frame();
            let radius = up(capsule.radius);
            (pose, format!("<capsule radius=\"{radius}\" length=\"{}\"/>", up(length)))
        }
    }
}

/// Writes the gripper: a frame between the fingertips, and two fingers whose drawn shapes give the opening.
fn gripper(out: &mut String, import: &Import<'_>) {
    let gripper = import.gripper;
    let last = &import.names.links[import.arm.last];
    if let Some(jaw) = &gripper.jaw {
        return one_jaw(out, import, jaw);
    }
    line(
        out,
        format_args!(
            "  <!-- z out of the fingers, y along their travel; the shapes above enclose the open fingers. -->"
        ),
    );
    joint(out, "arm_gripper_mount", "fixed", last, "arm_gripper", &gripper.frame);
    line(out, format_args!("  </joint>"));
    line(out, format_args!("  <link name=\"arm_gripper\"/>"));
    let travel = 0.5 * (gripper.open_m - gripper.closed_m);
    for (at, side) in [1.0, -1.0].into_iter().enumerate() {
        let (name, link) = (&import.names.fingers[at], format!("arm_finger_{}", at + 1));
        joint(out, name, "prismatic", last, &link, &gripper.frame);
        line(out, format_args!("    <axis xyz=\"0 {side} 0\"/>"));
        line(
            out,
            format_args!(
                "    <limit lower=\"0\" upper=\"{travel}\" velocity=\"{FINGER_M_S}\" effort=\"{}\"/>",
                gripper.force_n
            ),
        );
        if at == 1 {
            line(out, format_args!("    <mimic joint=\"{}\"/>", escaped(&import.names.fingers[0])));
        }
        line(out, format_args!("  </joint>"));
        let y = side * (0.5 * gripper.closed_m + 0.005);
        line(
            out,
            format_args!(
                "  <link name=\"{link}\"><visual><origin xyz=\"0 {y} -0.02\"/><geometry><box size=\"0.02 0.01 0.04\"/></geometry></visual></link>"
            ),
        );
    }
}

/// Thickness and length of a drawn fingertip, metres.
const PAD_M: [f64; 2] = [0.004, 0.025];

/// Writes the frames of the fixed finger's and of the jaw's tip, and the pads between which an object is held.
fn one_jaw(out: &mut String, import: &Import<'_>, jaw: &crate::gripper::Turning) {
    line(
        out,
        format_args!(
            "  <!-- At the tips of the fixed finger and of the jaw, on their inner faces: z out of the fingers, y towards \
             the jaw. -->"
        ),
    );
    let links = &import.names.links;
    let ends = [
        ("arm_gripper", import.arm.last, &import.gripper.frame, -1.0),
        ("arm_jaw", import.source.joints[jaw.joint].child, &jaw.tip, 1.0),
    ];
    for (name, parent, frame, side) in ends {
        joint(out, &format!("{name}_mount"), "fixed", &links[parent], name, frame);
        line(out, format_args!("  </joint>"));
        let [thick, long] = PAD_M;
        let (y, z, broad) = (0.5 * side * thick, -0.5 * long, up(jaw.breadth_m));
        line(
            out,
            format_args!(
                "  <link name=\"{name}\"><visual><origin xyz=\"0 {y} {z}\"/><geometry>\
                 <box size=\"{broad} {thick} {long}\"/></geometry></visual></link>"
            ),
        );
    }
}

/// A named posture of the arm.
pub(crate) type Posture = (&'static str, Vec<f64>);

/// Returns the SRDF.
pub(crate) fn srdf(import: &Import<'_>, postures: &[Posture]) -> String {
    let mut out = String::from("<?xml version=\"1.0\"?>\n");
    line(
        &mut out,
        format_args!(
            "<!-- Written by `whichone robot import`: postures, and links that may touch. -->"
        ),
    );
    line(&mut out, format_args!("<robot name=\"{}\">", import.name));
    for (name, positions) in postures {
        line(&mut out, format_args!("  <group_state name=\"{name}\" group=\"{LIMB}_arm\">"));
        for (joint, at) in import.arm.joints.iter().zip(positions) {
            let joint = escaped(&import.names.joints[*joint]);
            line(&mut out, format_args!("    <joint name=\"{joint}\" value=\"{at}\"/>"));
        }
        line(&mut out, format_args!("  </group_state>"));
    }
    let pair = |out: &mut String, (a, b): (usize, usize), reason: &str| {
        let [a, b] = [a, b].map(|link| escaped(&import.names.links[link]));
        line(
            out,
            format_args!("  <disable_collisions link1=\"{a}\" link2=\"{b}\" reason=\"{reason}\"/>"),
        );
    };
    for (own, reason) in import.pairs.excused() {
        pair(&mut out, own, reason);
    }
    for own in &import.fat {
        pair(&mut out, *own, "Shapes");
    }
    out.push_str("</robot>\n");
    out
}
