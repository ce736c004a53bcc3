//! The trait of a driver.

use manipulation::{Limb, Trajectory};
use messages::MotionInhibit;
use messages::robot::{Order, Report};
use vocabulary::time::{Span, Time};

use crate::{Command, Fault, Measured};

/// A robot or its model. The executor commands it a hundred times a second and trusts its sensors, so
/// a driver of a real robot has the same two tasks: forward the set point, and report what
/// the robot's sensors measure. Methods for real robots have defaults for a model.
///
/// A motion that belongs to a phase of a pick is commanded only in a pass after the one that made
/// the phase durable, so a driver may act on a command at once.
pub trait ArmDriver {
    /// Returns the present measurements.
    fn measured(&self) -> Measured;

    /// Commands one limb. It is called for every step of a motion and not while nothing
    /// moves: a limb without a command stays where it is. `seconds` have passed since the
    /// limb's last command, or since its motion began.
    fn command(&mut self, command: &Command, seconds: f64);

    /// Shows the motion of a limb of which the latest command is a part, `t_s` seconds from its start: a robot that
    /// follows trajectories by itself is given what comes next.
    fn look_ahead(&mut self, _limb: Limb, _motion: &Trajectory, _t_s: f64) {}

    /// Handles an order to the motion stop. Returns whether the driver brings the robot to rest by itself: without it
    /// the arm commands a halt on the planned path.
    fn stop(&mut self) -> bool {
        false
    }

    /// Handles a report of the robot.
    fn on_report(&mut self, _report: &Report<'_>, _now: Time) {}

    /// Begins a pass; `may_calibrate` marks the grippers, left first, that hold nothing a
    /// calibration would drop.
    fn begin_pass(&mut self, _now: Time, _may_calibrate: [bool; 2]) {}

    /// Ends a pass: limbs without a command are held where they are. Returns the
    /// orders to the robot.
    fn end_pass(&mut self, _now: Time) -> Vec<Order<'static>> {
        Vec::new()
    }

    /// Returns the reason why the robot cannot move at all.
    fn inhibit(&self) -> MotionInhibit {
        MotionInhibit::None
    }

    /// Returns the remedy for a robot that is not heard, in the imperative.
    fn remedy_for_silence(&self) -> &'static str {
        "start the robot"
    }

    /// Returns the fault of a limb that does not follow its commands.
    fn fault(&self) -> Option<Fault> {
        None
    }

    /// Returns whether a motion that ended with `command`, `late_s` seconds ago, has ended for the robot
    /// too.
    ///
    /// # Errors
    /// It has not ended in time.
    fn has_arrived(&mut self, _command: &Command, _late_s: f64) -> Result<bool, Fault> {
        Ok(true)
    }

    /// Returns whether joints and fingers stand still, so that a plan can start there.
    fn is_still(&self) -> bool {
        true
    }

    /// Drops the commands and holds the limbs where they are.
    fn hold_here(&mut self) {}

    /// Returns whether a new report should trigger a step at once.
    fn is_fresh(&self) -> bool {
        false
    }

    /// Returns the longest time between two passes, also at rest; `None` if standing needs no
    /// commands.
    fn beat(&self) -> Option<Span> {
        None
    }

    /// Returns the driver's state, for [`ArmDriver::resume`]; `None` where it has no description.
    fn checkpoint(&self) -> Option<Vec<u8>> {
        None
    }

    /// Takes over the state of another driver. Returns `None` if it is none of this driver.
    fn resume(&mut self, _checkpoint: &[u8]) -> Option<()> {
        None
    }
}
