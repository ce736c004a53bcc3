//! `arm.toml`: which arm, how it moves, and where it brings things.

use kinematics::{Limb, PlanSettings, Robot, gripper};

use crate::fields::Fields;

/// The arm.
#[derive(Clone, Debug, PartialEq)]
pub struct Arm {
    /// What it is made of: links, joints, limits, shapes.
    pub robot: Robot,
    /// What moves.
    pub driver: Driver,
    /// The limb that fetches; `None`: the one that reaches the object better.
    pub limb: Option<Limb>,
    /// How it moves, and where it brings things.
    pub plan: PlanSettings,
    /// Simulated seconds per second.
    pub time_scale: f64,
    /// Whether an object that was handed over is put back in its place in the simulated world.
    pub restock: bool,
    /// How often joint states are published, Hz.
    pub joint_rate_hz: f64,
}

/// What moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Driver {
    /// The kinematic model of Baxter in a simulated world.
    Kinematic,
}

/// Reads the section; the robot that it names is put in once its files have been read.
pub(crate) fn read(f: &mut Fields<'_>) -> Arm {
    f.text("robot");
    Arm {
        robot: Robot::baxter().clone(),
        driver: f.choice("driver", &[("kinematic", Driver::Kinematic)]),
        limb: f.choice(
            "limb",
            &[("auto", None), ("left", Some(Limb::Left)), ("right", Some(Limb::Right))],
        ),
        plan: plan(f),
        time_scale: f.number("time_scale", 0.01..=1000.0),
        restock: f.flag("restock"),
        joint_rate_hz: f.number("joint_rate_hz", 1.0..=1000.0),
    }
}

fn plan(f: &mut Fields<'_>) -> PlanSettings {
    PlanSettings {
        speed_ratio: f.number("speed_ratio", 0.05..=1.0),
        hover_m: f.number("hover_m", 0.02..=0.5),
        hand_over_xyz_m: f.triple("hand_over_xyz"),
        table_z_m: f.number("table_z_m", -1.0..=1.0),
        open_width_m: gripper::width_m(f.number("grip_open_percent", 1.0..=100.0)),
        standoff_m: f.number("standoff_m", 0.05..=1.0),
        point_s: f.number("point_s", 0.0..=60.0),
        margin_m: f.number("margin_m", 0.0..=0.2),
    }
}
