//! Orders to the motion stop that the arm has not confirmed.
//!
//! They take the motion stop's own path, which needs neither shared memory nor disk. A stop is
//! repeated until the arm confirms it, latched and at rest, or the operator resumes, however long
//! its service is away. Without a confirmation, every page warns, with the reason, until one does.

use std::io;

use messages::{MotionOrder, Service};
use serde::Serialize;
use service::group::GroupPaths;
use service::status::{GroupStatus, ServiceState};
use service::stop_socket::{Progress, StopClient, StopError, default_patience};
use service::{Span, Time};

use crate::hub::Hub;
use crate::hub::command::Motion;
use crate::hub::outbound::Answer;

/// Deadline for the arm to confirm a stop before pages warn.
const ALARM_AFTER: Span = Span::from_ms(1_000);
/// Most orders that wait for a confirmation; the latest is in force.
const ORDERS_MAX: usize = 64;

/// Orders that the arm has not confirmed.
#[derive(Debug)]
pub(super) struct Motions {
    client: StopClient,
    waiting: Vec<Motion>,
    latest: Option<Latest>,
}

#[derive(Debug)]
struct Latest {
    progress: Progress,
    /// Reason of a stop that pages warn about.
    late: Option<StopError>,
}

/// The section `motion`: the stop that the arm has not confirmed, if any.
#[derive(Debug, PartialEq, Serialize)]
pub(super) struct MotionSection {
    unconfirmed: Option<Unconfirmed>,
}

#[derive(Debug, PartialEq, Serialize)]
struct Unconfirmed {
    /// State of the arm's service; `silent` if it should answer and does not; `moving` if it is
    /// latched, but not at rest.
    why: &'static str,
}

impl Motions {
    /// Opens the path to the arm's service of a group, which may be there or not.
    ///
    /// # Errors
    /// No descriptor is left.
    pub(super) fn open(paths: &GroupPaths) -> io::Result<Self> {
        let client = StopClient::open(paths)?;
        Ok(Self { client, waiting: Vec::new(), latest: None })
    }

    /// Sends an order at once.
    pub(super) fn order(&mut self, motion: Motion, hub: &Hub, now: Time) {
        self.accept(motion, hub, now);
        self.latest.iter_mut().for_each(|latest| latest.progress.advance(&self.client, now));
    }

    fn accept(&mut self, motion: Motion, hub: &Hub, now: Time) {
        // The latest order overrules contrary ones.
        for old in self.waiting.extract_if(.., |waiting| waiting.stop != motion.stop) {
            let outcome = match old.stop {
                true => Ok(false),
                false => Err(StopError::Overruled.to_string()),
            };
            answer(hub, old, outcome);
        }
        if self.waiting.len() < ORDERS_MAX {
            self.waiting.push(motion);
        }
        let order = if motion.stop { MotionOrder::Stop } else { MotionOrder::Resume };
        match &mut self.latest {
            // A stop that its user repeats is as late as before.
            Some(latest) if latest.progress.order() == order => {
                latest.progress.renew(now, motion.of)
            }
            latest => {
                let progress = Progress::new(order, now, default_patience(order)).of(motion.of);
                *latest = Some(Latest { progress, late: None });
            }
        }
    }

    pub(super) fn is_waiting(&self) -> bool {
        self.latest.is_some()
    }

    /// Takes in the arm's answers, repeats the order until it is confirmed, warns of a late stop,
    /// and gives up a late release.
    pub(super) fn pass(&mut self, group: Option<&GroupStatus>, hub: &Hub, now: Time) {
        self.latest.iter_mut().for_each(|latest| latest.progress.advance(&self.client, now));
        self.judge(group, hub, now);
    }

    fn judge(&mut self, group: Option<&GroupStatus>, hub: &Hub, now: Time) {
        let Some(Latest { progress, late }) = &mut self.latest else { return };
        let is_stop = progress.order() == MotionOrder::Stop;
        match progress.result(now) {
            Some(Ok(state)) => self.done(hub, &Ok(state.stopped)),
            // A stop that another order has released is not repeated.
            Some(Err(StopError::Overruled)) if is_stop => self.done(hub, &Ok(false)),
            Some(Err(why)) if !is_stop => self.done(hub, &Err(why.to_string())),
            _ if is_stop && now >= progress.since() + ALARM_AFTER => {
                let why = progress.why(now);
                let text = match why_in_a_word(&why, group) {
                    "moving" | "silent" => why.to_string(),
                    state => format!("the arm's service is not ready ({state}): {why}"),
                };
                *late = Some(why);
                let text = format!("{text}; the stop is repeated until it is confirmed");
                self.waiting.drain(..).for_each(|motion| answer(hub, motion, Err(text.clone())));
            }
            _ => {}
        }
    }

    /// Ends the order.
    fn done(&mut self, hub: &Hub, outcome: &Result<bool, String>) {
        self.latest = None;
        self.waiting.drain(..).for_each(|motion| answer(hub, motion, outcome.clone()));
    }

    /// Returns the section for pages.
    pub(super) fn section(&self, group: Option<&GroupStatus>) -> MotionSection {
        let late = self.latest.as_ref().and_then(|latest| latest.late.as_ref());
        let unconfirmed = |why| Unconfirmed { why: why_in_a_word(why, group) };
        MotionSection { unconfirmed: late.map(unconfirmed) }
    }
}

/// Answers who gave an order: whether the stop is latched, or why that is not known.
fn answer(hub: &Hub, motion: Motion, outcome: Result<bool, String>) {
    if let Some(id) = motion.id {
        let outcome = outcome.map(|stopped| Some(Answer::Motion { stopped }));
        hub.answer(motion.viewer, id, outcome);
    }
}

/// Returns why the arm does not confirm, in a word.
fn why_in_a_word(why: &StopError, group: Option<&GroupStatus>) -> &'static str {
    let arm = group.and_then(|group| {
        group.services.iter().find(|service| service.name == Service::Arm.name())
    });
    match arm.map(|arm| arm.state) {
        _ if matches!(why, StopError::Moving(_)) => "moving",
        None | Some(ServiceState::Ready) => "silent",
        Some(state) => state.word(),
    }
}

#[cfg(test)]
mod tests {
    use messages::StopId;
    use serde_json::Value as Json;
    use service::status::ServiceStatus;
    use service::stop_socket::StopState;

    use super::*;
    use crate::hub::tests::{Page, hub, received};
    use crate::hub::{Role, ViewerId};

    fn group(state: ServiceState) -> GroupStatus {
        let arm = ServiceStatus { name: "arm".to_owned(), state, ..ServiceStatus::default() };
        GroupStatus { services: vec![arm], ..GroupStatus::default() }
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
            stop: StopId(0),
        }
    }

    fn stops(hub: &Hub, viewer: ViewerId, motions: &mut Motions, stop: bool, ms: u64) {
        motions.accept(Motion { viewer, id: Some(ms), stop, of: StopId(0) }, hub, at(ms));
    }

    /// Takes in an answer of the arm.
    fn confirm(motions: &mut Motions, state: StopState, hub: &Hub, now: Time) {
        let latest = motions.latest.as_mut().unwrap();
        latest.progress.on_answer(state, now);
        motions.judge(None, hub, now);
    }

    #[test]
    fn stop_of_an_absent_arm_raises_an_alarm_that_stays() {
        let Page { hub, .. } = hub();
        let (viewer, mut frames) = hub.join("", "a", Role::Operator, Time(0)).unwrap();
        let ((_home, mut motions), held) = (motions(), group(ServiceState::Held));
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
        let ready = group(ServiceState::Ready);
        motions.judge(Some(&ready), &hub, at(3_600_000));
        assert_eq!(section(&motions, &ready)["unconfirmed"]["why"], "silent");
        assert_eq!(received(&mut frames)["ok"], false, "answered at once");
        for other in [answer(3_600_000, false), answer(1, true)] {
            confirm(&mut motions, other, &hub, at(3_600_000));
            assert!(motions.is_waiting(), "{other:?}");
        }
        confirm(&mut motions, answer(3_600_000, true), &hub, at(3_600_000));
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
        confirm(&mut motions, later(false), &hub, at(3));
        assert!(!motions.is_waiting());
        let over = received(&mut frames);
        assert!(over["ok"] == true && over["stopped"] == false, "no page repeats it: {over}");

        stops(&hub, viewer, &mut motions, true, 1);
        confirm(&mut motions, later(true), &hub, at(3));
        assert!(!motions.is_waiting());
        assert_eq!(received(&mut frames)["stopped"], true, "another stop is in force");

        stops(&hub, viewer, &mut motions, false, 1);
        confirm(&mut motions, later(true), &hub, at(3));
        assert!(received(&mut frames)["error"].as_str().unwrap().contains("overruled"));

        let release = Motion { viewer, id: Some(1), stop: false, of: StopId(6) };
        motions.accept(release, &hub, at(9_000));
        let held = |stop| StopState { in_force_ns: 0, stop: StopId(stop), ..answer(9_000, true) };
        confirm(&mut motions, held(6), &hub, at(9_001));
        assert!(motions.is_waiting(), "the arm is about to release it");
        confirm(&mut motions, held(7), &hub, at(9_002));
        assert!(received(&mut frames)["error"].as_str().unwrap().contains("another stop"));
    }

    #[test]
    fn stop_of_an_arm_that_still_moves_is_not_confirmed_and_raises_its_own_alarm() {
        let Page { hub, .. } = hub();
        let (viewer, mut frames) = hub.join("", "a", Role::Operator, Time(0)).unwrap();
        let ((_home, mut motions), ready) = (motions(), group(ServiceState::Ready));
        stops(&hub, viewer, &mut motions, true, 1);
        let moving = StopState { at_rest: false, ..answer(1, true) };
        confirm(&mut motions, moving, &hub, at(950));
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
        confirm(&mut motions, moving, &hub, at(1_500));
        confirm(&mut motions, answer(1, true), &hub, at(1_550));
        assert_eq!(section(&motions, &ready)["unconfirmed"], Json::Null);
        assert!(!motions.is_waiting());
    }

    #[test]
    fn late_release_is_given_up() {
        let Page { hub, .. } = hub();
        let (viewer, mut frames) = hub.join("", "a", Role::Operator, Time(0)).unwrap();
        let ((_home, mut motions), ready) = (motions(), group(ServiceState::Ready));
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
