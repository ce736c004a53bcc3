//! Orders to the motion stop that the arm has not confirmed.
//!
//! They take the motion stop's own path, which needs neither shared memory nor disk. A stop is repeated
//! until the arm confirms it, latched and at rest, or the operator resumes, however long its service is away.
//! Where no confirmation comes, every page warns, with the reason, until one does.

use std::io;

use messages::{MotionOrder, Service};
use serde::Serialize;
use service::group::GroupPaths;
use service::status::{GroupStatus, ServiceState};
use service::stop_socket::{StopClient, StopError, StopState};
use service::{Span, Time, clock};

use crate::hub::Hub;
use crate::hub::command::Motion;
use crate::hub::outbound::Answer;

/// Interval at which an unconfirmed order is repeated.
const RESEND_EVERY: Span = Span::from_ms(50);
/// Deadline for the arm to confirm a stop before pages warn.
const ALARM_AFTER: Span = Span::from_ms(1_000);
/// Deadline for the arm to confirm a release; a later one would surprise.
const PATIENCE: Span = Span::from_ms(5_000);
/// Age from which the arm's answer that it moves is no longer true.
const ANSWER_AGE_MAX: Span = Span::from_ms(500);
/// Answer to a release that a later stop overrules.
const OVERRULED: &str = "overruled by a later stop";
/// Most orders that wait for a confirmation; the latest is in force.
const ORDERS_MAX: usize = 64;

/// Orders that the arm has not confirmed.
#[derive(Debug)]
pub(super) struct Motions {
    client: StopClient,
    waiting: Vec<Motion>,
    latest: Option<Latest>,
    /// `true` if nobody listens at the arm's end.
    is_absent: bool,
}

#[derive(Clone, Copy, Debug)]
struct Latest {
    stop: bool,
    given: Time,
    sent: Time,
    /// It is a stop that pages warn about.
    is_late: bool,
    /// Time of the arm's latest answer that it is latched, but not at rest.
    moved: Option<Time>,
}

/// The section `motion`: the stop that the arm has not confirmed, if any.
#[derive(Debug, PartialEq, Serialize)]
pub(super) struct MotionSection {
    unconfirmed: Option<Unconfirmed>,
}

#[derive(Debug, PartialEq, Serialize)]
struct Unconfirmed {
    /// State of the arm's service; `silent` if it should answer and does not; `moving` if it is latched, but
    /// not at rest.
    why: &'static str,
}

impl Motions {
    /// Opens the path to the arm's service of a group, which may be there or not.
    ///
    /// # Errors
    /// No descriptor is left.
    pub(super) fn open(paths: &GroupPaths) -> io::Result<Self> {
        let client = StopClient::open(paths)?;
        Ok(Self { client, waiting: Vec::new(), latest: None, is_absent: false })
    }

    /// Sends an order at once.
    pub(super) fn order(&mut self, motion: Motion, hub: &Hub, now: Time) {
        self.accept(motion, hub, now);
        self.send();
    }

    fn accept(&mut self, motion: Motion, hub: &Hub, now: Time) {
        // The latest order overrules contrary ones.
        let overruled = |waiting: &Motion| waiting.stop != motion.stop;
        for old in self.waiting.extract_if(.., |waiting| overruled(waiting)) {
            let outcome = match old.stop {
                true => Ok(Some(Answer::Motion { stopped: false })),
                false => Err(OVERRULED.to_owned()),
            };
            hub.answer(old.viewer, old.id, outcome);
        }
        if self.waiting.len() < ORDERS_MAX {
            self.waiting.push(motion);
        }
        // A stop that its user repeats is as late as before.
        let is_late = motion.stop && self.latest.is_some_and(|before| before.is_late);
        self.latest =
            Some(Latest { stop: motion.stop, given: now, sent: now, is_late, moved: None });
    }

    pub(super) fn is_waiting(&self) -> bool {
        self.latest.is_some()
    }

    /// Takes in the arm's answers, repeats the order until it is confirmed, warns of a late stop, and gives up
    /// a late release.
    pub(super) fn pass(&mut self, group: Option<&GroupStatus>, hub: &Hub, now: Time) {
        while let Some(state) = self.client.take() {
            self.confirm(&state, hub, now);
        }
        self.judge(group, hub, now);
        if self.latest.is_some_and(|latest| now >= latest.sent + RESEND_EVERY) {
            self.send();
        }
    }

    /// Takes in an answer; one to another order does not confirm this one.
    fn confirm(&mut self, state: &StopState, hub: &Hub, now: Time) {
        let is_it = |latest: &&mut Latest| state.given_ns == latest.given.ns();
        let Some(latest) = self.latest.as_mut().filter(is_it) else { return };
        match state.stopped {
            true if latest.stop && !state.at_rest => latest.moved = Some(now),
            stopped if stopped == latest.stop => {
                self.latest = None;
                self.done(hub, stopped);
            }
            // Of the command line, or of another console.
            stopped if state.in_force_ns > state.given_ns => {
                self.latest = None;
                match stopped {
                    true => self.refuse(hub, OVERRULED),
                    // A stop that is over is not repeated.
                    false => self.done(hub, false),
                }
            }
            _ => {}
        }
    }

    fn done(&mut self, hub: &Hub, stopped: bool) {
        for motion in self.waiting.drain(..) {
            hub.answer(motion.viewer, motion.id, Ok(Some(Answer::Motion { stopped })));
        }
    }

    /// Sends the order with its original time, which makes repetitions harmless.
    fn send(&mut self) {
        let Some(latest) = &mut self.latest else { return };
        latest.sent = clock::now();
        let order = if latest.stop { MotionOrder::Stop } else { MotionOrder::Resume };
        let sent = self.client.send(order, latest.given);
        self.is_absent = matches!(sent, Err(StopError::Absent));
        if let Err(error) = sent {
            tracing::debug!(%error, "order to the motion stop not sent");
        }
    }

    fn judge(&mut self, group: Option<&GroupStatus>, hub: &Hub, now: Time) {
        let Some(latest) = &mut self.latest else { return };
        latest.moved = latest.moved.filter(|moved| now < *moved + ANSWER_AGE_MAX);
        if latest.stop {
            latest.is_late |= now >= latest.given + ALARM_AFTER;
        } else if now >= latest.given + PATIENCE {
            self.latest = None;
            return self.refuse(hub, "the arm does not answer; help: see the list of services");
        }
        if let Some(latest) =
            self.latest.filter(|latest| latest.is_late && !self.waiting.is_empty())
        {
            let what = match why(&latest, group) {
                "moving" => "the arm has the stop, but is not at rest".to_owned(),
                "silent" if self.is_absent => "the arm's service is not running".to_owned(),
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
        MotionSection { unconfirmed: late.map(|latest| Unconfirmed { why: why(&latest, group) }) }
    }
}

/// Returns why the arm does not confirm, in a word.
fn why(latest: &Latest, group: Option<&GroupStatus>) -> &'static str {
    let arm = group.and_then(|group| {
        group.services.iter().find(|service| service.name == Service::Arm.name())
    });
    match arm.map(|arm| arm.state) {
        _ if latest.moved.is_some() => "moving",
        None | Some(ServiceState::Ready) => "silent",
        Some(state) => state.word(),
    }
}

#[cfg(test)]
mod tests {
    use serde_json::{Value as Json, json};

    use super::*;
    use crate::hub::tests::{Page, hub, received};
    use crate::hub::{Role, ViewerId};

    fn group(state: &str) -> GroupStatus {
        let arm = json!({ "name": "arm", "wanted": "up", "actual": "down", "state": state,
                          "incarnation": 1, "restarts": 0 });
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

    fn motions() -> (tempfile::TempDir, Motions) {
        let home = tempfile::tempdir().unwrap();
        let paths = GroupPaths::in_home(home.path(), &"lab".parse().unwrap()).unwrap();
        let motions = Motions::open(&paths).unwrap();
        (home, motions)
    }

    fn answer(given_ms: u64, stopped: bool) -> StopState {
        let given_ns = at(given_ms).ns();
        let inhibit = messages::MotionInhibit::None;
        StopState {
            given_ns,
            in_force_ns: given_ns,
            stopped,
            at_rest: true,
            durable: true,
            inhibit,
        }
    }

    fn stops(hub: &Hub, viewer: ViewerId, motions: &mut Motions, stop: bool, ms: u64) {
        motions.accept(Motion { viewer, id: ms, stop }, hub, at(ms));
    }

    #[test]
    fn stop_of_an_absent_arm_raises_an_alarm_that_stays() {
        let Page { hub, .. } = hub();
        let (viewer, mut frames) = hub.join("", "a", Role::Operator, Time(0)).unwrap();
        let ((_home, mut motions), held) = (motions(), group("held"));
        stops(&hub, viewer, &mut motions, true, 1);
        motions.judge(Some(&held), &hub, at(1_000));
        assert_eq!(section(&motions, &held)["unconfirmed"], Json::Null);
        assert!(frames.try_recv().is_err());
        motions.judge(Some(&held), &hub, at(1_001));
        assert_eq!(section(&motions, &held)["unconfirmed"]["why"], "held");
        let late = received(&mut frames);
        assert!(late["ok"] == false && late["error"].as_str().unwrap().contains("emergency stop"));
        // Pressed again, an hour later, by a service that is back and silent: still not confirmed.
        stops(&hub, viewer, &mut motions, true, 3_600_000);
        let ready = group("ready");
        motions.judge(Some(&ready), &hub, at(3_600_000));
        assert_eq!(section(&motions, &ready)["unconfirmed"]["why"], "silent");
        assert_eq!(received(&mut frames)["ok"], false, "answered at once");
        for other in [answer(3_600_000, false), answer(1, true)] {
            motions.confirm(&other, &hub, at(3_600_000));
            assert!(motions.is_waiting(), "{other:?}");
        }
        motions.confirm(&answer(3_600_000, true), &hub, at(3_600_000));
        assert_eq!(section(&motions, &ready)["unconfirmed"], Json::Null);
        assert!(!motions.is_waiting());
    }

    #[test]
    fn stop_that_another_order_overrules_is_over() {
        let Page { hub, .. } = hub();
        let (viewer, mut frames) = hub.join("", "a", Role::Operator, Time(0)).unwrap();
        let (_home, mut motions) = motions();
        stops(&hub, viewer, &mut motions, true, 1);
        let later = |stopped| StopState { in_force_ns: at(2).ns(), ..answer(1, stopped) };
        motions.confirm(&later(false), &hub, at(3));
        assert!(!motions.is_waiting());
        let over = received(&mut frames);
        assert!(over["ok"] == true && over["stopped"] == false, "no page repeats it: {over}");

        stops(&hub, viewer, &mut motions, true, 1);
        motions.confirm(&later(true), &hub, at(3));
        assert!(!motions.is_waiting());
        assert_eq!(received(&mut frames)["stopped"], true, "another stop is in force");

        stops(&hub, viewer, &mut motions, false, 1);
        motions.confirm(&later(true), &hub, at(3));
        assert!(received(&mut frames)["error"].as_str().unwrap().contains("overruled"));
    }

    #[test]
    fn stop_of_an_arm_that_still_moves_is_not_confirmed_and_raises_its_own_alarm() {
        let Page { hub, .. } = hub();
        let (viewer, mut frames) = hub.join("", "a", Role::Operator, Time(0)).unwrap();
        let ((_home, mut motions), ready) = (motions(), group("ready"));
        stops(&hub, viewer, &mut motions, true, 1);
        let moving = StopState { at_rest: false, ..answer(1, true) };
        motions.confirm(&moving, &hub, at(950));
        motions.judge(Some(&ready), &hub, at(1_000));
        assert!(motions.is_waiting() && frames.try_recv().is_err());
        assert_eq!(section(&motions, &ready)["unconfirmed"], Json::Null);

        motions.judge(Some(&ready), &hub, at(1_001));
        assert_eq!(section(&motions, &ready)["unconfirmed"]["why"], "moving");
        let late = received(&mut frames);
        assert!(late["error"].as_str().unwrap().contains("not at rest"), "{late}");
        // It falls silent: that it moves is no longer known.
        motions.judge(Some(&ready), &hub, at(1_450));
        assert_eq!(section(&motions, &ready)["unconfirmed"]["why"], "silent");
        motions.confirm(&moving, &hub, at(1_500));
        motions.confirm(&answer(1, true), &hub, at(1_550));
        assert_eq!(section(&motions, &ready)["unconfirmed"], Json::Null);
        assert!(!motions.is_waiting());
    }

    #[test]
    fn late_release_is_given_up() {
        let Page { hub, .. } = hub();
        let (viewer, mut frames) = hub.join("", "a", Role::Operator, Time(0)).unwrap();
        let ((_home, mut motions), ready) = (motions(), group("ready"));
        stops(&hub, viewer, &mut motions, true, 0);
        stops(&hub, viewer, &mut motions, false, 1);
        assert_eq!(received(&mut frames)["stopped"], false, "the stop is over");
        motions.judge(Some(&ready), &hub, at(5_000));
        assert!(motions.is_waiting());
        motions.judge(Some(&ready), &hub, at(5_001));
        assert!(!motions.is_waiting());
        assert_eq!(received(&mut frames)["ok"], false);
        assert!(frames.try_recv().is_err(), "answered once");
    }
}
