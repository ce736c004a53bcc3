//! Arm, lift and gripper of a description, found by its structure: no name decides.

use diagnostics::Diagnostic;
use robot_model::JointKind;

use crate::options::{Gripper as Asked, Options};
use crate::report::Findings;
use crate::source::{Joint, Source};

/// Fewest turning joints before a gripper, and of what counts as a limb.
const LIMB_MIN: usize = 4;

/// Most moving joints of a gripper, and of one of its fingers.
const GRIPPER_MAX: usize = 14;
const FINGER_MAX: usize = 3;

/// A jaw turns from about zero by no more than this, radians: a wrist turns further, or to both sides.
const JAW_MAX: f64 = 2.3;
const JAW_CLOSED: f64 = 0.25;

/// The arm that fetches.
#[derive(Clone, Debug)]
pub(crate) struct Arm {
    /// The link that its first joint hangs on.
    pub(crate) base: usize,
    /// Sliding joints below the base: they stand still.
    pub(crate) lift: Vec<usize>,
    /// Its turning joints, shoulder first: five to seven.
    pub(crate) joints: Vec<usize>,
    /// The link that the last one moves.
    pub(crate) last: usize,
    /// The link that carries the fingers; the last one where there are none.
    pub(crate) hand: usize,
    /// Moving joints of the gripper, followers too.
    pub(crate) fingers: Vec<usize>,
}

/// A way of moving joints out from the root, and the gripper at its end.
#[derive(Clone, Debug)]
struct Limb {
    way: Vec<usize>,
    fingers: Vec<usize>,
}

/// Finds the arm.
///
/// # Errors
/// There is none with five to seven turning joints, or a link that was asked for does not exist.
pub(crate) fn find(
    source: &Source,
    options: &Options,
    findings: &mut Findings,
) -> Result<Arm, Diagnostic> {
    let named = |name: &Option<String>, option: &str| {
        let Some(name) = name else { return Ok(None) };
        let found = source.link(name).map(Some);
        found.ok_or_else(|| {
            let known = source.links.iter().map(|link| link.name.as_str());
            let help =
                diagnostics::suggestion(name, known, || "name a link of the file".to_owned());
            Diagnostic::new("", option, format!("the robot has no link {name:?}"), help)
        })
    };
    let base = named(&options.base, "--base")?;
    let tip = named(&options.tip, "--tip")?;
    let hand = match &options.gripper {
        Asked::Link(name) => named(&Some(name.clone()), "--gripper")?,
        Asked::Found | Asked::None => None,
    };
    let mut limb = limb(source, tip.or(hand), findings)?;
    if let Some(base) = base {
        limb.way.retain(|joint| source.is_below(source.joints[*joint].parent, base));
    }
    if let Some(hand) = hand {
        limb.way.retain(|joint| source.is_below(hand, source.joints[*joint].child));
        limb.fingers = moving_below(source, hand);
    }
    if options.gripper == Asked::None {
        limb.fingers.clear();
    }
    arm(source, limb, hand, findings)
}

/// Returns the limb that ends at a link, else the one with the most turning joints.
fn limb(source: &Source, tip: Option<usize>, findings: &mut Findings) -> Result<Limb, Diagnostic> {
    let mut all = Vec::new();
    walk(source, source.root(), &[], &mut all);
    if let Some(tip) = tip {
        let own = all.into_iter().find(|limb| {
            limb.way.last().is_some_and(|last| {
                let last = source.joints[*last].child;
                source.is_below(tip, last) || source.is_below(last, tip)
            })
        });
        let way = || moving(source, source.way(tip));
        return Ok(own.unwrap_or_else(|| Limb { way: way(), fingers: moving_below(source, tip) }));
    }
    all.retain(|limb| turning(source, &limb.way) >= LIMB_MIN);
    let most = all.iter().map(|limb| turning(source, &limb.way).min(7)).max();
    let longest = all.iter().position(|limb| Some(turning(source, &limb.way).min(7)) == most);
    let Some(longest) = longest else {
        let what = format!("no limb with {LIMB_MIN} or more turning joints in a row");
        let help = "name the link at the end of the arm: --tip LINK";
        return Err(Diagnostic::new("", "robot", what, help));
    };
    let end = |limb: &Limb| {
        limb.way.last().map_or("", |last| source.links[source.joints[*last].child].name.as_str())
    };
    if all.len() > 1 {
        let ends: Vec<&str> = all.iter().map(end).collect();
        findings.chosen(format!(
            "of {} limbs, which end in {}, the one of {}: the first of the longest; --tip LINK chooses another",
            all.len(),
            ends.join(", "),
            end(&all[longest])
        ));
    }
    Ok(all.swap_remove(longest))
}

/// Collects the limbs that hang on `link`; `way` is how it is reached.
fn walk(source: &Source, link: usize, way: &[usize], all: &mut Vec<Limb>) {
    let kids: Vec<(usize, Vec<usize>)> = source
        .children(link)
        .map(|joint| (joint, joint_and_below(source, joint)))
        .filter(|(_, moving)| !moving.is_empty())
        .collect();
    let rest: Vec<usize> = kids.iter().flat_map(|(_, moving)| moving).copied().collect();
    if rest.is_empty() {
        return all.push(Limb { way: way.to_vec(), fingers: Vec::new() });
    }
    if is_gripper(source, way, &kids, &rest) {
        return all.push(Limb { way: way.to_vec(), fingers: rest });
    }
    for (joint, _) in kids {
        let mut further = way.to_vec();
        if moves(&source.joints[joint]) {
            further.push(joint);
        }
        walk(source, source.joints[joint].child, &further, all);
    }
}

/// Whether the joints behind an arm are fingers: all slide or are coupled, or they fork into short chains, or there is a
/// single jaw. One turning joint with more behind it is still arm.
fn is_gripper(
    source: &Source,
    way: &[usize],
    kids: &[(usize, Vec<usize>)],
    rest: &[usize],
) -> bool {
    if turning(source, way) < LIMB_MIN || rest.len() > GRIPPER_MAX {
        return false;
    }
    let is_led = |joint: usize| {
        rest.iter().any(|other| source.joints[*other].follows.is_some_and(|it| it.joint == joint))
    };
    let is_finger = |joint: &usize| {
        let own = &source.joints[*joint];
        own.kind == JointKind::Prismatic || own.follows.is_some() || is_led(*joint)
    };
    if rest.iter().all(is_finger) {
        return true;
    }
    if let [only] = rest {
        return is_jaw(&source.joints[*only]);
    }
    kids.len() > 1 && kids.iter().all(|(_, moving)| moving.len() <= FINGER_MAX)
}

fn is_jaw(joint: &Joint) -> bool {
    let Some((low, high)) = joint.range.filter(|_| joint.kind == JointKind::Revolute) else {
        return false;
    };
    high - low > 0.0 && high - low < JAW_MAX && low.abs().min(high.abs()) <= JAW_CLOSED
}

fn moves(joint: &Joint) -> bool {
    joint.kind != JointKind::Fixed
}

fn turning(source: &Source, way: &[usize]) -> usize {
    way.iter().filter(|joint| source.joints[**joint].turns()).count()
}

fn moving(source: &Source, way: Vec<usize>) -> Vec<usize> {
    way.into_iter().filter(|joint| moves(&source.joints[*joint])).collect()
}

fn joint_and_below(source: &Source, joint: usize) -> Vec<usize> {
    let own = &source.joints[joint];
    let mut all = if moves(own) { vec![joint] } else { Vec::new() };
    all.extend(moving_below(source, own.child));
    all
}

fn moving_below(source: &Source, link: usize) -> Vec<usize> {
    source.children(link).flat_map(|joint| joint_and_below(source, joint)).collect()
}

/// Divides a limb into lift and arm.
fn arm(
    source: &Source,
    limb: Limb,
    hand: Option<usize>,
    findings: &mut Findings,
) -> Result<Arm, Diagnostic> {
    let name = |joint: &usize| source.joints[*joint].name.as_str();
    let first = limb.way.iter().position(|joint| source.joints[*joint].turns());
    let (lift, joints) = limb.way.split_at(first.unwrap_or(limb.way.len()));
    let count = joints.len();
    let all_turn = joints.iter().all(|joint| source.joints[*joint].turns());
    if !all_turn || !matches!(count, 5..=7) {
        return Err(refusal(source, joints, &limb.fingers));
    }
    let last = source.joints[joints[count - 1]].child;
    let base = source.joints[joints[0]].parent;
    let hand = hand.unwrap_or_else(|| common(source, &limb.fingers).unwrap_or(last));
    findings.chosen(format!(
        "arm: {count} turning joints in a row, {} to {}",
        name(&joints[0]),
        name(&joints[count - 1])
    ));
    findings.chosen(format!(
        "base: {}, the link that the first of them hangs on",
        source.links[base].name
    ));
    for joint in lift {
        findings.assumed(format!(
            "lift {} below the base stands still at {:.3} m",
            name(joint),
            middle(source, *joint)
        ));
    }
    Ok(Arm {
        base,
        lift: lift.to_vec(),
        joints: joints.to_vec(),
        last,
        hand,
        fingers: limb.fingers,
    })
}

/// Position at which a lift stands: the middle of its range.
pub(crate) fn middle(source: &Source, joint: usize) -> f64 {
    let (low, high) = source.joints[joint].span();
    0.5 * (low + high)
}

/// The link that all of some joints hang on.
fn common(source: &Source, joints: &[usize]) -> Option<usize> {
    let mut at = source.joints[*joints.first()?].parent;
    while !joints.iter().all(|joint| source.is_below(source.joints[*joint].parent, at)) {
        at = source.joints[source.links[at].carrier?].parent;
    }
    Some(at)
}

fn refusal(source: &Source, joints: &[usize], fingers: &[usize]) -> Diagnostic {
    let list: Vec<String> = joints
        .iter()
        .map(|joint| {
            format!("{} ({})", source.joints[*joint].name, source.joints[*joint].kind.name())
        })
        .collect();
    let gripper = match fingers.len() {
        0 => "no gripper behind them".to_owned(),
        1 => "one joint of a gripper behind them".to_owned(),
        count => format!("{count} joints of a gripper behind them"),
    };
    let what = format!(
        "expected an arm of five to seven turning joints, found {}: {}, with {gripper}",
        joints.len(),
        list.join(", ")
    );
    let help = match joints.len() {
        0..=4 => {
            "an arm of fewer joints cannot grasp from above in every direction; if the arm is longer, name its ends: \
             --base LINK --tip LINK"
        }
        _ => "name the link that the arm hangs on and the one at its end: --base LINK --tip LINK",
    };
    Diagnostic::new("", "robot", what, help)
}
