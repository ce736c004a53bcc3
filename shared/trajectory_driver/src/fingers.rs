//! The fingers: the command in force, and what its end says.

use arm_driver::Fingers;
use manipulation::gripper::{self, Gripper};
use serde::{Deserialize, Serialize};
use service::{Span, Time};

use crate::{CANCEL_FINGERS_MS, FingerEnd, FingerOrder, GripperController};

/// Share of the fingers' travel by which they may miss the position to which they open, per cent.
const OPEN_SLACK_PERCENT: f64 = 5.0;

/// The gripper of the limb.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct FingerState {
    geometry: Gripper,
    /// The command in force.
    order: Option<FingerOrder>,
    /// Number of the latest command that was cancelled before its end, and when.
    cancelled: Option<(u64, Time)>,
    /// Latest end of a command, of this process or one before.
    end: Option<FingerEnd>,
    /// Measured share of the travel, per cent.
    percent: Option<f64>,
}

impl FingerState {
    pub(crate) fn new(geometry: &Gripper) -> Self {
        Self { geometry: *geometry, order: None, cancelled: None, end: None, percent: None }
    }

    /// Takes over a report. Returns the measured width, metres.
    pub(crate) fn on_report(
        &mut self,
        end: Option<FingerEnd>,
        position: Option<f64>,
        controller: &GripperController,
    ) -> Option<f64> {
        self.end = end;
        self.percent = position.map(|position| controller.percent(position)).or(self.percent);
        self.percent.map(|percent| self.geometry.width_m(percent))
    }

    /// Commands the fingers of a motion.
    pub(crate) fn want(&mut self, fingers: Fingers, controller: &GripperController, now: Time) {
        let (percent, closes) = match fingers {
            Fingers::Stay => return,
            Fingers::Open(width_m) => (self.geometry.percent(width_m), false),
            Fingers::Grip(_) => (0.0, true),
        };
        let position = controller.position(percent);
        if self.order.is_some_and(|it| (it.position, it.closes) == (position, closes)) {
            return;
        }
        // A number that a process before this one cannot have used.
        let before =
            self.order.map(|order| order.number).max(self.cancelled.map(|(number, _)| number));
        let number = (now.ns() / 1_000_000).max(before.unwrap_or(0) + 1);
        self.order = Some(FingerOrder { number, position, closes });
    }

    /// Returns the command in force.
    pub(crate) fn order(&self) -> Option<FingerOrder> {
        self.order
    }

    /// Forgets the command, which is cancelled: the next one is sent anew.
    pub(crate) fn forget(&mut self, now: Time) {
        let own_end = self.own_end();
        if let Some(order) = self.order.take().filter(|_| own_end.is_none()) {
            self.cancelled = Some((order.number, now));
        }
    }

    fn own_end(&self) -> Option<FingerEnd> {
        let order = self.order?;
        self.end.filter(|end| end.number == order.number)
    }

    /// Returns whether the end of the command in force, or of a cancelled one, is awaited.
    pub(crate) fn is_moving(&self, now: Time) -> bool {
        let is_cancelling = |(number, at): (u64, Time)| {
            self.end.is_none_or(|end| end.number < number)
                && now.since(at) <= Span::from_ms(CANCEL_FINGERS_MS)
        };
        self.order.is_some() && self.own_end().is_none()
            || self.cancelled.is_some_and(is_cancelling)
    }

    /// Returns whether the fingers have completed their command; `Err` if their controller has not carried it out.
    pub(crate) fn has_settled(&self, controller: &GripperController) -> Result<bool, ()> {
        let Some(order) = self.order else { return Ok(true) };
        match self.own_end() {
            None => Ok(false),
            Some(end) if end.reached || end.closes && end.stalled => Ok(true),
            // Fingers that stall just before the position to which they open are open.
            Some(end) if end.stalled && self.is_at(controller.percent(order.position)) => Ok(true),
            Some(_) => Err(()),
        }
    }

    fn is_at(&self, wanted: f64) -> bool {
        self.percent.is_some_and(|percent| (percent - wanted).abs() < OPEN_SLACK_PERCENT)
    }

    /// Returns whether something is between the fingers: they stopped at it, whatever the status of the command, and
    /// stand apart.
    pub(crate) fn holding(&self, now: Time) -> Option<bool> {
        if self.percent.is_some_and(|percent| percent <= 100.0 * gripper::DEAD_ZONE) {
            return Some(false);
        }
        match self.end {
            _ if self.is_moving(now) => None,
            Some(end) if end.closes && end.stalled => Some(true),
            Some(end) if end.reached => Some(false),
            _ => None,
        }
    }
}
