//! A chain of five to seven turning joints of any kind.

use super::five::Five;
use super::frame::Frame;
use super::six::{Found, Six};
use super::zero::ZeroPosture;
use crate::kinematics::chain::trig::sin_cos;
use crate::kinematics::limb::Joints;
use nalgebra::{Isometry3, Vector3};

/// Each joint turns about the z axis of its own frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct General {
    /// Each frame at zero in the one before, the first in `base`.
    steps: [Frame; 7],
    /// The tool in the last frame.
    tool: Frame,
    /// Number of joints that move; those behind stand at zero.
    joints: usize,
    /// Closed form, for five or six joints of a known family.
    closed: Option<Closed>,
}

/// A closed form.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Closed {
    Five(Five),
    Six(Six),
}

impl Closed {
    /// Returns every posture that takes the tool to `target`; see [`Six::postures`].
    pub(crate) fn postures(&self, target: &Isometry3<f64>, last_rad: f64) -> Vec<Found> {
        match self {
            Self::Five(arm) => arm.postures(target),
            Self::Six(arm) => arm.postures(target, last_rad),
        }
    }
}

impl General {
    pub(crate) fn of(posture: &ZeroPosture) -> Self {
        let frames = posture.axes.map(|axis| {
            let z = axis.direction;
            // Any direction that is not z itself will do for what x is at right angles to.
            let aside = if z.x.abs() < 0.9 { Vector3::x() } else { Vector3::y() };
            let x = aside.cross(&z).normalize();
            Frame { x, y: z.cross(&x), z, origin: axis.point }
        });
        let steps = std::array::from_fn(|i| {
            if i == 0 { frames[0] } else { frames[i - 1].relative(&frames[i]) }
        });
        let joints = posture.joints;
        let closed = match joints {
            5 => Five::of(posture).map(Closed::Five),
            6 => Six::of(posture).map(Closed::Six),
            _ => None,
        };
        Self { steps, tool: frames[6].relative(&Frame::from(&posture.tool)), joints, closed }
    }

    /// Returns the number of joints that move.
    pub(crate) fn joints(&self) -> usize {
        self.joints
    }

    /// Returns the closed form, if there is one.
    pub(crate) fn closed(&self) -> Option<&Closed> {
        self.closed.as_ref()
    }

    /// Returns a point of the first axis, in `base`, metres.
    pub(crate) fn shoulder(&self) -> Vector3<f64> {
        self.steps[0].origin
    }

    /// Returns the frames at `q`, in `base`.
    pub(crate) fn frames(&self, q: &Joints) -> [Frame; 7] {
        let turns = sin_cos(q);
        let mut last = self.steps[0].turned_z(turns[0]);
        let mut frames = [last; 7];
        for i in 1..7 {
            last = last.compose(&self.steps[i]).turned_z(turns[i]);
            frames[i] = last;
        }
        frames
    }

    pub(crate) fn tool_on(&self, last: &Frame) -> Frame {
        last.compose(&self.tool)
    }
}
