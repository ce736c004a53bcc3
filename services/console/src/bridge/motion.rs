//! Orders to the motion stop that the arm has not confirmed.

use messages::{ArmStatus, MotionCommand, MotionOrder};
use service::bus::Writer;
use service::{Span, Time};

use crate::hub::Hub;
use crate::hub::command::Motion;
use crate::hub::outbound::Answer;

/// Interval at which an unconfirmed order is repeated.
const RESEND_EVERY: Span = Span::from_ms(50);
/// Deadline for the arm to confirm an order.
const PATIENCE: Span = Span::from_ms(5_000);
/// Most orders that wait for a confirmation; the latest is in force.
const ORDERS_MAX: usize = 64;

/// Orders that the arm has not confirmed.
#[derive(Debug, Default)]
pub(super) struct Motions {
    waiting: Vec<Motion>,
    latest: Option<Latest>,
}

#[derive(Clone, Copy, Debug)]
struct Latest {
    stop: bool,
    given: Time,
    sent: Time,
}

impl Motions {
    /// Sends an order at once.
    pub(super) fn order(
        &mut self,
        motion: Motion,
        writer: &Writer<MotionCommand>,
        hub: &Hub,
        now: Time,
    ) {
        // The latest order overrules contrary ones.
        let overruled = |waiting: &Motion| waiting.stop != motion.stop;
        for old in self.waiting.extract_if(.., |waiting| overruled(waiting)) {
            hub.answer(old.viewer, old.id, Err("overruled by another order".to_owned()));
        }
        if self.waiting.len() < ORDERS_MAX {
            self.waiting.push(motion);
        }
        let latest = Latest { stop: motion.stop, given: now, sent: now };
        self.latest = Some(latest);
        send(latest, writer);
    }

    pub(super) fn is_waiting(&self) -> bool {
        self.latest.is_some()
    }

    /// Takes in a status that the arm sent at `sent`; one from before the order does not confirm it.
    pub(super) fn confirm(&mut self, status: &ArmStatus, sent: Time, hub: &Hub) {
        let Some(latest) = self.latest.filter(|latest| sent >= latest.given) else { return };
        if (status.stopped != 0) == latest.stop {
            self.latest = None;
            for motion in self.waiting.drain(..) {
                let answer = Answer::Motion { stopped: latest.stop };
                hub.answer(motion.viewer, motion.id, Ok(Some(answer)));
            }
        }
    }

    /// Repeats the order until it is confirmed, or gives up.
    pub(super) fn pass(&mut self, writer: &Writer<MotionCommand>, hub: &Hub, now: Time) {
        let Some(latest) = &mut self.latest else { return };
        if now >= latest.given + PATIENCE {
            let why = "the arm does not answer; help: use its emergency stop, and see the list of services";
            for motion in self.waiting.drain(..) {
                hub.answer(motion.viewer, motion.id, Err(why.to_owned()));
            }
            self.latest = None;
        } else if now >= latest.sent + RESEND_EVERY {
            latest.sent = now;
            send(*latest, writer);
        }
    }
}

/// Sends an order with its original time: the arm ignores orders older than the last that it obeyed.
fn send(latest: Latest, writer: &Writer<MotionCommand>) {
    let order = if latest.stop { MotionOrder::Stop } else { MotionOrder::Resume };
    let command = MotionCommand {
        given_ns: latest.given.ns(),
        order: order.into(),
        ..MotionCommand::default()
    };
    if let Err(error) = writer.send(&command) {
        tracing::warn!(%error, "motion stop order not sent");
    }
}
