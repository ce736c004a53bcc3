//! Which servo moves which joint, and the translation of its steps.

use std::f64::consts::TAU;

use diagnostics::Diagnostic;
use manipulation::{Limb, Robot};

use crate::calibration::{Calibrated, Calibration};
use crate::registers::STEPS;
use crate::settings::{Feetech, JointEntry};

/// How far a joint's limits may exceed its servo's recorded range, radians.
const EXCESS_RAD: f64 = 0.05;

/// The servos: those of the joints from the shoulder on, then the jaw's.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Layout {
    pub(crate) members: Vec<Member>,
}

/// A servo and the part that it moves.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Member {
    /// The joint; of the jaw the servo's name.
    pub(crate) joint: String,
    pub(crate) calibrated: Calibrated,
    pub(crate) unit: Unit,
}

/// What the position of a servo means.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Unit {
    /// The angle of a joint, radians.
    Angle { zero_rad: f64, reversed: bool },
    /// The opening of the jaw, percent.
    Percent,
}

impl Member {
    pub(crate) fn id(&self) -> u8 {
        self.calibrated.id
    }

    /// The joint and its servo, for a person.
    pub(crate) fn name(&self) -> String {
        format!("servo {} ({})", self.id(), self.joint)
    }

    /// The joint's position: radians, or percent of the jaw.
    pub(crate) fn value(&self, steps: i32) -> f64 {
        match self.unit {
            Unit::Angle { zero_rad, reversed } => {
                zero_rad + sign(reversed) * self.calibrated.radians(steps)
            }
            Unit::Percent => self.calibrated.percent(steps),
        }
    }

    /// The servo's position, within its range.
    pub(crate) fn steps(&self, value: f64) -> u16 {
        match self.unit {
            Unit::Angle { zero_rad, reversed } => {
                self.calibrated.steps(sign(reversed) * (value - zero_rad))
            }
            Unit::Percent => self.calibrated.steps_of_percent(value),
        }
    }

    /// The joint's speed by its servo's in steps/s.
    pub(crate) fn speed(&self, steps: i32) -> f64 {
        match self.unit {
            Unit::Angle { reversed, .. } => sign(reversed) * f64::from(steps) * TAU / STEPS,
            Unit::Percent => self.calibrated.percent(steps) - self.calibrated.percent(0),
        }
    }
}

fn sign(reversed: bool) -> f64 {
    if reversed { -1.0 } else { 1.0 }
}

impl Layout {
    /// Finds the servo of each joint.
    ///
    /// # Errors
    /// Joints without a servo, joints that may move further than theirs, entries of `joints` that are of no joint, and
    /// servos that would move two: all of them.
    pub(crate) fn new(
        settings: &Feetech,
        robot: &Robot,
        calibration: &Calibration,
    ) -> Result<Self, Vec<Diagnostic>> {
        let arm = robot.arm(Limb::Only);
        let file = calibration.file.display().to_string();
        let (mut members, mut problems) = (Vec::new(), entries(&settings.joints, &arm.joint_names));
        let limits = arm.limits.position.0;
        for (joint, (lower, upper)) in arm.joint_names.iter().zip(limits) {
            let entry = settings.joints.iter().find(|entry| entry.joint == *joint);
            let servo = entry.map_or(joint, |entry| &entry.servo);
            let Some(calibrated) = calibration.servos.get(servo) else {
                problems.push(without_servo(&file, joint, servo, calibration));
                continue;
            };
            let (zero_rad, reversed) =
                entry.map_or((0.0, false), |entry| (entry.zero_rad, entry.reversed));
            let reach = calibrated.reach_rad() + EXCESS_RAD;
            if lower < zero_rad - reach || upper > zero_rad + reach {
                problems.push(too_far(
                    &file,
                    joint,
                    (lower, upper),
                    (zero_rad, calibrated.reach_rad()),
                ));
            }
            let unit = Unit::Angle { zero_rad, reversed };
            members.push(Member { joint: joint.clone(), calibrated: *calibrated, unit });
        }
        match jaw(&settings.gripper, &file, calibration) {
            Ok(jaw) => members.push(jaw),
            Err(problem) => problems.push(problem),
        }
        problems.extend(shared(&members));
        if problems.is_empty() { Ok(Self { members }) } else { Err(problems) }
    }

    pub(crate) fn ids(&self) -> Vec<u8> {
        self.members.iter().map(Member::id).collect()
    }
}

/// What is wrong with the entries of joints: joints that the robot does not have, or that have two entries.
fn entries(entries: &[JointEntry], joints: &[String]) -> Vec<Diagnostic> {
    let mut problems = Vec::new();
    for (place, JointEntry { joint, .. }) in entries.iter().enumerate() {
        if !joints.contains(joint) {
            let what = format!("joint `{joint}` is unknown: expected one of {}", joints.join(", "));
            let near = diagnostics::nearest(joint, joints.iter().map(String::as_str));
            let help = near.map_or_else(
                || "remove the entry".to_owned(),
                |near| format!("write `joint = \"{near}\"`, or remove the entry"),
            );
            problems.push(of_joints(what, help));
        } else if entries[..place].iter().any(|before| before.joint == *joint) {
            let what = format!("joint `{joint}` has two entries");
            problems.push(of_joints(what, "remove one of them".to_owned()));
        }
    }
    problems
}

/// Servos that move two joints, or a joint and the jaw.
fn shared(members: &[Member]) -> Vec<Diagnostic> {
    let mut problems = Vec::new();
    for (place, member) in members.iter().enumerate() {
        if let Some(before) = members[..place].iter().find(|before| before.id() == member.id()) {
            let what =
                format!("{} and {} have the servo {}", before.joint, member.joint, member.id());
            let help =
                "give each joint a servo of its own, and the jaw another one: arm.feetech.gripper";
            problems.push(of_joints(what, help.to_owned()));
        }
    }
    problems
}

fn of_joints(what: String, help: String) -> Diagnostic {
    Diagnostic::new("arm.toml", "arm.feetech.joints", what, help)
}

/// The servo of the jaw.
fn jaw(servo: &str, file: &str, calibration: &Calibration) -> Result<Member, Diagnostic> {
    let calibrated = calibration.servos.get(servo);
    let calibrated =
        calibrated.ok_or_else(|| without_servo(file, "of the gripper", servo, calibration))?;
    Ok(Member { joint: servo.to_owned(), calibrated: *calibrated, unit: Unit::Percent })
}

fn without_servo(file: &str, joint: &str, servo: &str, calibration: &Calibration) -> Diagnostic {
    let known: Vec<&str> = calibration.servos.keys().map(String::as_str).collect();
    let what =
        format!("joint {joint} has no servo: expected `{servo}`, found {}", known.join(", "));
    let near = diagnostics::nearest(servo, known.iter().copied()).unwrap_or("NAME");
    let help = match joint {
        "of the gripper" => format!("name it in arm.toml: [feetech] gripper = \"{near}\""),
        _ => format!(
            "name it in arm.toml: [feetech] joints = [{{ joint = \"{joint}\", servo = \"{near}\" }}]"
        ),
    };
    Diagnostic::new(file, servo, what, help)
}

fn too_far(
    file: &str,
    joint: &str,
    (lower, upper): (f64, f64),
    (zero, reach): (f64, f64),
) -> Diagnostic {
    let (least, most) = (zero - reach, zero + reach);
    let what = format!(
        "joint {joint} may move from {lower:.3} to {upper:.3} rad by the robot's file, its servo from {least:.3} to \
         {most:.3} rad"
    );
    let help = "calibrate again through the joint's whole range, narrow its <limit>, or set its zero_rad in \
                arm.feetech.joints";
    Diagnostic::new(file, joint, what, help)
}
