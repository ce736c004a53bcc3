//! What keeps the robot from moving, and what becomes of a motion then.

use crate::state::Cause;
use crate::{ArmNode, Fx};
use manipulation::Limb;
use messages::{Hindrance, MotionOrder, PickPhase};
use service::Time;

impl ArmNode {
    /// Looks at the robot before anything is decided: whether it can move, and whether it moves as
    /// it was commanded to.
    pub(crate) fn feel(&mut self, now: Time, fx: &mut Fx) {
        self.driver.begin_pass(now, self.may_calibrate());
        let hindrance = self.driver.hindrance();
        if hindrance != self.hindrance {
            self.hindrance = hindrance;
            tell(hindrance);
        }
        match hindrance {
            Hindrance::Stopped | Hindrance::Error | Hindrance::Disabled => {
                self.stand_still(now, fx);
            }
            _ => {}
        }
        if hindrance == Hindrance::Stopped && !self.state.stopped {
            self.state.stopped = true;
            self.record(Cause::Motion(MotionOrder::Stop), now, fx);
        }
        if let Some(fault) = self.driver.fault() {
            self.block(&fault, now, fx);
        }
    }

    /// The robot has stopped by itself and obeys nothing: what was being done is not done any more.
    fn stand_still(&mut self, now: Time, fx: &mut Fx) {
        if !self.executor.is_standing() {
            self.executor.stand();
            self.record(Cause::Moved, now, fx);
        }
    }

    /// Which grippers hold nothing that a calibration would drop, as far as is known.
    fn may_calibrate(&self) -> [bool; 2] {
        let phase = self.state.open_pick().map(|pick| pick.phase);
        let grasps = matches!(phase, Some(PickPhase::Closing | PickPhase::Holding));
        Limb::BOTH.map(|limb| {
            let held = self.state.held.is_some_and(|held| held.limb == limb);
            let grasping = grasps && self.state.limb == Some(limb);
            !held && !grasping
        })
    }
}

fn tell(hindrance: Hindrance) {
    match hindrance {
        Hindrance::None => tracing::info!("the robot can move"),
        Hindrance::Calibrating => tracing::info!("a gripper is not calibrated yet"),
        _ => tracing::warn!(cure = cure(hindrance), "{}", what(hindrance)),
    }
}

fn what(hindrance: Hindrance) -> &'static str {
    match hindrance {
        Hindrance::None | Hindrance::Calibrating => "",
        Hindrance::Stopped => "the robot's emergency stop holds; the motion stop is latched",
        Hindrance::Error => "the robot has a fault",
        Hindrance::Disabled => "the robot is disabled",
        Hindrance::Unheard => "the robot is not heard, or not all of it",
        Hindrance::Stale => "what the robot measures does not come any more; the arm halts",
        Hindrance::Gripper => "a gripper has a fault, or is not the electric one",
    }
}

/// What a person can do about it.
fn cure(hindrance: Hindrance) -> &'static str {
    match hindrance {
        Hindrance::None | Hindrance::Calibrating => "",
        Hindrance::Stopped => {
            "release the button, reset and enable the robot, then: whichone resume-motion"
        }
        Hindrance::Error => "look at the robot, then reset and enable it",
        Hindrance::Disabled => "enable the robot; the arm goes on by itself then",
        Hindrance::Unheard => {
            "start the robot's bridge or whichone-baxter; with one gripper only, set arm.limb"
        }
        Hindrance::Stale => {
            "look at the robot's bridge and network; the arm goes on by itself then"
        }
        Hindrance::Gripper => "reset the gripper, or set arm.limb to the limb that has a good one",
    }
}
