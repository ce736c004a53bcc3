//! Objects from perception: the tracker follows the reports of sources, and each change of the
//! table is a step of the dialogue, durable and only taken while the arm has no order.

use std::collections::VecDeque;

use dialogue::manager::Cause;
use messages::{ArmStatus, Change, ChangeAnswer, Sighting, TableObject, TableView, WorldView};
use perception::{Hiding, Live, Refusal, Settings, Tracker};
use scene::ObjectId;
use service::Time;
use service::bounded::push_bounded;
use vocabulary::{PickPhase, Table};

use crate::{Fx, Out, PolicyNode};

/// Answers to changes by hand that are published.
const ANSWERS_MAX: usize = 16;
/// Change of an estimate that is not published at once, metres or radians.
const STEP: f64 = 0.002;

/// The tracker of objects with inputs and outputs.
#[derive(Debug)]
pub(crate) struct Perceived {
    settings: Settings,
    /// `None` until the table is known.
    tracker: Option<Tracker>,
    hiding: Hiding,
    answers: VecDeque<ChangeAnswer>,
    refused: u64,
    refusal: String,
    /// The estimates as they were last published.
    published: Vec<(ObjectId, Live)>,
}

impl Perceived {
    pub(crate) fn new(settings: Settings) -> Self {
        Self {
            settings,
            tracker: None,
            hiding: Hiding::default(),
            answers: VecDeque::new(),
            refused: 0,
            refusal: String::new(),
            published: Vec::new(),
        }
    }

    /// Counts a refusal. Returns whether it differs from the latest one.
    fn refuse(&mut self, source: &str, refusal: &Refusal) -> bool {
        let latest = std::mem::replace(&mut self.refusal, format!("{source}: {refusal}"));
        self.refused += 1;
        if self.refusal != latest {
            tracing::warn!(source, %refusal, "a report of objects is refused");
        }
        self.refusal != latest
    }

    fn answer(&mut self, key: u64, outcome: Result<ObjectId, &Refusal>) {
        self.answers.retain(|answer| answer.key != key);
        let (object, refusal) = match outcome {
            Ok(object) => (object.0, String::new()),
            Err(refusal) => (0, refusal.to_string()),
        };
        push_bounded(&mut self.answers, ANSWERS_MAX, ChangeAnswer { key, object, refusal });
    }

    /// Returns the state of each object of the table.
    fn live(&self, table: &Table) -> Vec<(ObjectId, Live)> {
        let of = |object: &scene::Perceived| {
            let live = self.tracker.as_ref().and_then(|tracker| tracker.live(object.number));
            let [x, y, z] = object.xyz;
            let place = [x, y, z, object.yaw];
            let unseen = Live { place, sd: [0.0; 4], seen: Time(0), gone: false };
            (object.number, live.unwrap_or(unseen))
        };
        table.objects.iter().map(of).collect()
    }

    fn view(&self, table: &Table) -> TableView {
        let of = |(object, (_, live)): (&scene::Perceived, &(ObjectId, Live))| TableObject {
            known: object.clone(),
            place: live.place,
            sd: live.sd,
            seen_ns: live.seen.ns(),
            gone: live.gone,
        };
        TableView {
            version: table.version,
            objects: table.objects.iter().zip(&self.published).map(of).collect(),
            answers: self.answers.iter().cloned().collect(),
            refused: self.refused,
            refusal: self.refusal.clone(),
        }
    }
}

impl PolicyNode {
    /// Notes which object the arm grasps or carries.
    pub(crate) fn note_handling(&mut self, status: &ArmStatus) {
        let Some(perceived) = &mut self.perceived else { return };
        let handling = [PickPhase::Closing, PickPhase::Holding, PickPhase::Returning];
        let handles = handling.contains(&status.phase.get());
        let object = u16::try_from(status.object).ok().map(ObjectId);
        perceived.hiding.handled = object.filter(|_| handles);
    }

    /// Notes the positions of the grippers.
    pub(crate) fn note_grippers(&mut self, world: &WorldView) {
        if let Some(perceived) = &mut self.perceived {
            let finite = world.grippers.iter().filter(|pose| pose.iter().all(|it| it.is_finite()));
            perceived.hiding.grippers = finite.map(|[x, y, z, ..]| [*x, *y, *z]).collect();
        }
    }

    /// Takes in a report of a source.
    pub(crate) fn sight(&mut self, sighting: &Sighting, now: Time, fx: &mut Fx) {
        let (Some(perceived), Some(table)) = (&mut self.perceived, &self.state.table) else {
            return;
        };
        let is_by_hand = !matches!(sighting.change, Change::Look(_));
        let known = table.edits.iter().find(|(key, _)| *key == sighting.key);
        let answered = perceived.answers.iter().any(|answer| answer.key == sighting.key);
        if is_by_hand && (known.is_some() || answered) {
            if let (Some((key, object)), false) = (known, answered) {
                perceived.answer(*key, Ok(*object));
            }
            return;
        }
        let is_busy = self.state.ordered().is_some() || self.state.putting_back.is_some();
        let Some(tracker) = &mut perceived.tracker else { return };
        let taken = match is_by_hand && is_busy {
            true => Err(Refusal::Fetching),
            false => tracker.take(sighting, self.manager.scene_file(), &perceived.hiding, now),
        };
        let refusal = taken.as_ref().err();
        let is_new = refusal.is_some_and(|refusal| perceived.refuse(&sighting.source, refusal));
        if let (true, Some(outcome)) = (is_by_hand, taken.as_ref().copied().transpose()) {
            perceived.answer(sighting.key, outcome);
        }
        let changed = taken.unwrap_or_default();
        // Detections of a look may be used beside one that is refused.
        self.step_table(changed.map(|object| (sighting.key, object)), now, fx);
        if is_by_hand || is_new {
            self.send_table(now, fx);
        } else {
            self.send_changed_table(now, fx);
        }
    }

    /// Makes the objects that the tracker reports those of the dialogue, if they have changed and
    /// the arm has no order.
    pub(crate) fn step_table(&mut self, edit: Option<(u64, ObjectId)>, now: Time, fx: &mut Fx) {
        let is_busy = self.state.ordered().is_some() || self.state.putting_back.is_some();
        let (Some(perceived), Some(table), false) =
            (&mut self.perceived, &self.state.table, is_busy)
        else {
            return;
        };
        let Some(tracker) = &mut perceived.tracker else { return };
        if self.state.handed_over.is_none() && self.state.with_user.is_none() {
            let over: Vec<ObjectId> =
                table.objects.iter().filter(|it| it.taken).map(|it| it.number).collect();
            over.into_iter().for_each(|number| tracker.remove(number));
        }
        let objects = tracker.objects();
        if objects == table.objects && edit.is_none() {
            return;
        }
        tracker.forget_gone();
        let (version, edits) = (table.version + 1, table.edits.clone());
        let mut next = Table { version, next: tracker.next(), objects, edits };
        if let Some((key, object)) = edit {
            next.note(key, object);
        }
        let (before, after) = (table.objects.len(), next.objects.len());
        tracing::info!(version = next.version, before, after, "the table has changed");
        self.apply(Cause::Objects(next), now, fx);
    }

    /// Reports the dialogue's effects on the objects to the tracker.
    pub(crate) fn sync_table(&mut self, now: Time) {
        let (Some(perceived), Some(table)) = (&mut self.perceived, &self.state.table) else {
            return;
        };
        let (settings, file) = (&perceived.settings, self.manager.scene_file());
        let new = || Tracker::new(settings.clone(), table, file, now);
        let tracker = perceived.tracker.get_or_insert_with(new);
        table.objects.iter().for_each(|object| tracker.hand_over(object.number, object.taken));
    }

    /// Publishes the table.
    pub(crate) fn send_table(&mut self, now: Time, fx: &mut Fx) {
        self.sync_table(now);
        let (Some(perceived), Some(table)) = (&mut self.perceived, &self.state.table) else {
            return;
        };
        perceived.published = perceived.live(table);
        fx.publish(Out::Objects(Box::new(perceived.view(table))));
    }

    /// Publishes the table if an estimate has changed, or something was answered.
    fn send_changed_table(&mut self, now: Time, fx: &mut Fx) {
        let (Some(perceived), Some(table)) = (&self.perceived, &self.state.table) else { return };
        let live = perceived.live(table);
        let differs = |(a, b): (&(ObjectId, Live), &(ObjectId, Live))| {
            let moved = a.1.place.iter().zip(b.1.place).any(|(a, b)| (a - b).abs() > STEP);
            a.0 != b.0 || a.1.gone != b.1.gone || moved
        };
        let published = &perceived.published;
        if live.len() != published.len() || live.iter().zip(published).any(differs) {
            self.send_table(now, fx);
        }
    }
}
