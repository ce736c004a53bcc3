//! Orders to the motion stop that the arm has not confirmed.
//!
//! A stop is repeated until the arm confirms it or the operator resumes, however long its service is away.
//! Where no confirmation comes, every page warns, with the reason, until one does.

use messages::{ArmStatus, MotionCommand, MotionOrder, Service};
use serde::Serialize;
use service::bus::Writer;
use service::status::GroupStatus;
use service::{Span, Time};

use crate::hub::command::Motion;
use crate::hub::outbound::Answer;
use crate::hub::{Hub, ms};

/// Interval at which an unconfirmed order is repeated.
const RESEND_EVERY: Span = Span::from_ms(50);
/// Deadline for the arm to confirm a stop before pages warn.
const ALARM_AFTER: Span = Span::from_ms(1_000);
/// Deadline for the arm to confirm a release; a later one would surprise.
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
    /// It is a stop that pages warn about.
    is_late: bool,
}

/// The section `motion`: the stop that the arm has not confirmed, if any.
#[derive(Debug, PartialEq, Serialize)]
pub(super) struct MotionSection {
    unconfirmed: Option<Unconfirmed>,
}

#[derive(Debug, PartialEq, Serialize)]
struct Unconfirmed {
    /// State of the arm's service, or `silent` if it runs and does not answer.
    why: &'static str,
    since_ms: f64,
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
        self.accept(motion, hub, now);
        self.latest.iter().for_each(|latest| send(latest, writer));
    }

    fn accept(&mut self, motion: Motion, hub: &Hub, now: Time) {
        // The latest order overrules contrary ones.
        let overruled = |waiting: &Motion| waiting.stop != motion.stop;
        for old in self.waiting.extract_if(.., |waiting| overruled(waiting)) {
            hub.answer(old.viewer, old.id, Err("overruled by another order".to_owned()));
        }
        if self.waiting.len() < ORDERS_MAX {
            self.waiting.push(motion);
        }
        // A stop that is repeated by its user is as late as before.
        let before = self.latest.filter(|before| before.stop && motion.stop && before.is_late);
        let new = Latest { stop: motion.stop, given: now, sent: now, is_late: false };
        self.latest = Some(before.unwrap_or(new));
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

    /// Repeats the order until it is confirmed, warns of a late stop, and gives up a late release.
    pub(super) fn pass(
        &mut self,
        writer: &Writer<MotionCommand>,
        group: Option<&GroupStatus>,
        hub: &Hub,
        now: Time,
    ) {
        self.judge(group, hub, now);
        let Some(latest) = &mut self.latest else { return };
        if now >= latest.sent + RESEND_EVERY {
            latest.sent = now;
            send(latest, writer);
        }
    }

    fn judge(&mut self, group: Option<&GroupStatus>, hub: &Hub, now: Time) {
        let Some(latest) = &mut self.latest else { return };
        if latest.stop {
            latest.is_late |= now >= latest.given + ALARM_AFTER;
        } else if now >= latest.given + PATIENCE {
            self.latest = None;
            return self.refuse(hub, "the arm does not answer; help: see the list of services");
        }
        if self.latest.is_some_and(|latest| latest.is_late) && !self.waiting.is_empty() {
            let what = match why(group) {
                "silent" => "the arm does not answer".to_owned(),
                state => format!("the arm's service is not ready ({state})"),
            };
            let help = "help: use the robot's own emergency stop; the stop is repeated until it is confirmed";
            self.refuse(hub, &format!("{what}, and the robot may still move; {help}"));
        }
    }

    fn refuse(&mut self, hub: &Hub, why: &str) {
        for motion in self.waiting.drain(..) {
            hub.answer(motion.viewer, motion.id, Err(why.to_owned()));
        }
    }

    /// Returns what pages show.
    pub(super) fn section(&self, group: Option<&GroupStatus>) -> MotionSection {
        let late = self.latest.filter(|latest| latest.is_late);
        let unconfirmed =
            late.map(|latest| Unconfirmed { why: why(group), since_ms: ms(latest.given) });
        MotionSection { unconfirmed }
    }
}

/// Returns why the arm does not confirm, in a word.
fn why(group: Option<&GroupStatus>) -> &'static str {
    let arm = group.and_then(|group| {
        group.services.iter().find(|service| service.name == Service::Arm.name())
    });
    match arm.map(|arm| arm.state()) {
        None | Some("ready") => "silent",
        Some(state) => state,
    }
}

/// Sends an order with its original time: the arm ignores orders older than the last that it obeyed.
fn send(latest: &Latest, writer: &Writer<MotionCommand>) {
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

#[cfg(test)]
mod tests {
    use serde_json::{Value as Json, json};

    use super::*;
    use crate::hub::tests::{Page, hub, received};
    use crate::hub::{Role, ViewerId};

    fn group(actual: &str) -> GroupStatus {
        let arm = json!({ "name": "arm", "wanted": "up", "actual": actual, "incarnation": 1,
                          "restarts": 0 });
        let group = json!({ "name": "lab", "state": "ready", "supervisor_pid": 7, "version": "0",
                            "epoch": 1, "uptime_s": 1.0, "scene": "bowls", "config": "/c",
                            "strays_killed": 0, "services": [arm] });
        serde_json::from_value(group).unwrap()
    }

    fn at(ms: u64) -> Time {
        Time(1_000_000 * ms)
    }

    fn section(motions: &Motions, group: &GroupStatus) -> Json {
        serde_json::to_value(motions.section(Some(group))).unwrap()
    }

    fn stops(hub: &Hub, viewer: ViewerId, motions: &mut Motions, stop: bool, ms: u64) {
        motions.accept(Motion { viewer, id: ms, stop }, hub, at(ms));
    }

    #[test]
    fn stop_of_an_absent_arm_raises_an_alarm_that_stays() {
        let Page { hub, .. } = hub();
        let (viewer, mut frames) = hub.join("", "a", Role::Operator, Time(0)).unwrap();
        let (mut motions, held) = (Motions::default(), group("held"));
        stops(&hub, viewer, &mut motions, true, 1);
        motions.judge(Some(&held), &hub, at(1_000));
        assert_eq!(section(&motions, &held)["unconfirmed"], Json::Null);
        assert!(frames.try_recv().is_err());
        motions.judge(Some(&held), &hub, at(1_001));
        assert_eq!(section(&motions, &held)["unconfirmed"]["why"], "held");
        let answer = received(&mut frames);
        assert!(
            answer["ok"] == false && answer["error"].as_str().unwrap().contains("emergency stop")
        );
        // Pressed again, an hour later, by a service that is back and silent: still not confirmed.
        stops(&hub, viewer, &mut motions, true, 3_600_000);
        let ready = group("ready");
        motions.judge(Some(&ready), &hub, at(3_600_000));
        assert_eq!(section(&motions, &ready)["unconfirmed"]["why"], "silent");
        assert_eq!(received(&mut frames)["ok"], false, "answered at once");
        let moving = ArmStatus::default();
        motions.confirm(&moving, at(3_600_001), &hub);
        assert!(motions.is_waiting());
        motions.confirm(&ArmStatus { stopped: 1, ..moving }, at(3_600_001), &hub);
        assert_eq!(section(&motions, &ready)["unconfirmed"], Json::Null);
        assert!(!motions.is_waiting());
    }

    #[test]
    fn late_release_is_given_up() {
        let Page { hub, .. } = hub();
        let (viewer, mut frames) = hub.join("", "a", Role::Operator, Time(0)).unwrap();
        let (mut motions, ready) = (Motions::default(), group("ready"));
        stops(&hub, viewer, &mut motions, true, 0);
        stops(&hub, viewer, &mut motions, false, 1);
        assert!(received(&mut frames)["error"].as_str().unwrap().contains("overruled"));
        motions.judge(Some(&ready), &hub, at(5_000));
        assert!(motions.is_waiting());
        motions.judge(Some(&ready), &hub, at(5_001));
        assert!(!motions.is_waiting());
        assert_eq!(received(&mut frames)["ok"], false);
        assert!(frames.try_recv().is_err(), "answered once");
    }
}
