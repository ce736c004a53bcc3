//! Reasons why the robot cannot move, and their effect on a motion.

use crate::state::Cause;
use crate::{ArmNode, Fx};
use messages::{MotionInhibit, MotionOrder, PickPhase};
use service::Time;

impl ArmNode {
    /// Reads the robot's sensors before a decision: whether it can move, and whether it moves as
    /// commanded.
    pub(crate) fn read_sensors(&mut self, now: Time, fx: &mut Fx) {
        self.driver.begin_pass(now, self.may_calibrate());
        use MotionInhibit::{Disabled, Error, Stopped};
        let inhibit = self.driver.inhibit();
        if inhibit != self.inhibit {
            self.inhibit = inhibit;
            log(inhibit, self.driver.remedy_for_silence());
            // Who saw the stop before has not seen this one.
            if inhibit == Stopped {
                self.latch_new_stop(now, fx);
            }
        }
        if matches!(inhibit, Stopped | Error | Disabled) {
            self.stand_still(now, fx);
            // Nothing begins to move because somebody enables the robot.
            if inhibit == Stopped || self.intended(now).is_some() {
                self.latch_stop(now, fx);
            }
        }
        if let Some(fault) = self.driver.fault() {
            self.block(&fault, now, fx);
        }
    }

    /// Drops the motion of a robot that has stopped and accepts no commands.
    fn stand_still(&mut self, now: Time, fx: &mut Fx) {
        if !self.executor.is_standing() {
            self.executor.stand();
            self.record(Cause::Moved, now, fx);
        }
    }

    /// Latches the motion stop as an order that is given now would.
    pub(crate) fn latch_stop(&mut self, now: Time, fx: &mut Fx) {
        if !self.state.stopped {
            self.latch_new_stop(now, fx);
        }
    }

    /// As [`ArmNode::latch_stop`], also over an earlier stop, whose release then no longer counts.
    pub(crate) fn latch_new_stop(&mut self, now: Time, fx: &mut Fx) {
        (self.state.stopped, self.state.obeyed) = (true, now);
        self.urgent = true;
        self.record(Cause::Motion(MotionOrder::Stop), now, fx);
    }

    /// Returns the grippers, left first, that hold nothing a calibration would drop.
    fn may_calibrate(&self) -> [bool; 2] {
        let phase = self.state.open_pick().map(|pick| pick.phase);
        let grasps = phase.is_some_and(|phase| phase >= PickPhase::Closing);
        let mut may_calibrate = [true; 2];
        for limb in self.config.setup.robot.limbs() {
            let held = self.state.held.is_some_and(|held| held.limb == *limb);
            let grasping = grasps && self.state.limb == Some(*limb);
            may_calibrate[*limb] = !held && !grasping;
        }
        may_calibrate
    }
}

/// Logs the reason, and the remedy for the operator.
fn log(inhibit: MotionInhibit, remedy_for_silence: &str) {
    let (what, help) = match inhibit {
        MotionInhibit::None => return tracing::info!("the robot can move"),
        MotionInhibit::Calibrating => return tracing::info!("a gripper is not calibrated yet"),
        MotionInhibit::Stopped => (
            "the robot's emergency stop holds; the motion stop is latched",
            "release the button, reset and enable the robot, then: whichone resume-motion",
        ),
        MotionInhibit::Error => (
            "the robot has a fault; a motion under way is stopped",
            "check the robot, reset and enable it, then: whichone resume-motion",
        ),
        MotionInhibit::Disabled => (
            "the robot is disabled; a motion under way is stopped",
            "enable the robot, then: whichone resume-motion",
        ),
        MotionInhibit::Unheard => {
            ("no messages from the robot, or from a part of it", remedy_for_silence)
        }
        MotionInhibit::Stale => (
            "joint states are stale; halting",
            "check the robot's bridge and network; the arm resumes with fresh joint states",
        ),
        MotionInhibit::Gripper => (
            "a gripper has a fault, or is not the electric one",
            "reset the gripper, or set arm.limb to the limb with a working one",
        ),
    };
    tracing::warn!(help, "{what}");
}
