//! The tracker: follows objects through looks, and says which there are.

use scene::{ObjectId, Perceived, Scene};
use vocabulary::Table;
use vocabulary::time::{Span, Time};

use crate::checks::{check_values, frame_named, in_base, placed};
use crate::estimate::Estimate;
use crate::{Change, Detection, Frame, Look, Refusal, Sighting, labels};
use track::{Candidate, Track};

mod looks;
mod track;

/// Settings of the tracker.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Consecutive detections before an object is added.
    pub appear: u32,
    /// Distance up to which an object has not moved, metres.
    pub moved_m: f64,
    /// Distance up to which a detection may be of an object, metres.
    pub gate_m: f64,
    /// Time without a detection before an object is removed.
    pub vanish: Span,
    /// Greatest age of a look.
    pub age_max: Span,
    /// Distance from a gripper within which an object is hidden, metres.
    pub hidden_m: f64,
    /// Frames besides `base`.
    pub frames: Vec<Frame>,
}

/// Positions and objects hidden by the arm.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Hiding {
    /// Positions of the grippers, metres.
    pub grippers: Vec<[f64; 3]>,
    /// The object being grasped or carried: sightings of it say nothing.
    pub handled: Option<ObjectId>,
}

/// State of an object at this moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Live {
    /// Centre, metres, and yaw, radians: the best estimate.
    pub place: [f64; 4],
    /// Standard deviation of each.
    pub sd: [f64; 4],
    /// Time of the last sighting.
    pub seen: Time,
    /// Whether it went without a detection for so long that it is gone.
    pub gone: bool,
}

/// Follows the objects on the table.
#[derive(Clone, Debug)]
pub struct Tracker {
    settings: Settings,
    tracks: Vec<Track>,
    candidates: Vec<Candidate>,
    next: ObjectId,
    /// When the latest look of each source was taken.
    looked: Vec<(String, Time)>,
}

impl Tracker {
    /// Continues from a table. `file` is the scene file, whose own numbers are never given.
    pub fn new(settings: Settings, table: &Table, file: &Scene, now: Time) -> Self {
        let track = |object: &Perceived| Track {
            object: object.clone(),
            estimate: Estimate::stated(&Detection {
                classes: object.classes.clone(),
                attributes: object.attributes.clone(),
                xyz: object.xyz,
                yaw: object.yaw,
                ..Detection::default()
            }),
            track: None,
            // Looks that waited during a restart are older than it.
            seen: now - settings.age_max,
            stood: now - settings.age_max,
            missed: Span(0),
            misses: 0,
        };
        let next = table.next.max(ObjectId::from(file.objects().len()));
        let tracks = table.objects.iter().map(track).collect();
        Self { settings, tracks, candidates: Vec::new(), next, looked: Vec::new() }
    }

    /// Takes in a report of a source. Returns the object of a change by hand.
    ///
    /// # Errors
    /// Why it was not used. Of a look with detections that cannot be used the others are.
    pub fn take(
        &mut self,
        sighting: &Sighting,
        file: &Scene,
        hiding: &Hiding,
        now: Time,
    ) -> Result<Option<ObjectId>, Refusal> {
        let Sighting { source, frame, change, .. } = sighting;
        match change {
            Change::Look(look) => {
                let (seen, refusals) = in_base(&self.settings.frames, frame, &look.seen, file)?;
                // A detection with a wrong number may be of any object.
                let whole = look.whole && !refusals.contains(&Refusal::Number);
                self.look(source, &Look { seen, whole, ..*look }, file, hiding, now)?;
                refusals.into_iter().next().map_or(Ok(None), Err)
            }
            Change::Add(detection) => {
                check_values(detection, file)?;
                let detection = placed(frame_named(&self.settings.frames, frame)?, detection)?;
                let estimate = Estimate::stated(&labels::read(detection, file)?);
                self.appear(estimate, None, now).map(Some).ok_or(Refusal::Full(self.tracks.len()))
            }
            Change::Move { object, xyz, yaw } => {
                let of = Detection { xyz: *xyz, yaw: *yaw, ..Detection::default() };
                let of = placed(frame_named(&self.settings.frames, frame)?, &of)?;
                let track = self.named(object)?;
                track.estimate.put(of.xyz, of.yaw);
                (track.missed, track.misses) = (Span(0), 0);
                track.report(0.0);
                Ok(Some(track.object.number))
            }
            Change::Remove { object } => {
                let number = self.named(object)?.object.number;
                self.remove(number);
                Ok(Some(number))
            }
        }
    }

    /// Returns the objects, each as it was last reported: places that differ by less than the
    /// settings' step are the same.
    pub fn objects(&self) -> Vec<Perceived> {
        let there = self.tracks.iter().filter(|track| !self.is_gone(track));
        there.map(|it| it.object.clone()).collect()
    }

    /// Returns the least number that no object has had.
    pub fn next(&self) -> ObjectId {
        self.next
    }

    /// Returns the state of an object at this moment.
    pub fn live(&self, number: ObjectId) -> Option<Live> {
        let track = self.tracks.iter().find(|track| track.object.number == number)?;
        Some(Live {
            place: track.estimate.place,
            sd: track.estimate.variance.map(f64::sqrt),
            seen: track.seen,
            gone: self.is_gone(track),
        })
    }

    /// Notes that an object was handed to a person, or was put back in its place. One that a person
    /// has is not looked for.
    pub fn hand_over(&mut self, number: ObjectId, taken: bool) {
        let changed = |it: &&mut Track| it.object.number == number && it.object.taken != taken;
        if let Some(track) = self.tracks.iter_mut().find(changed) {
            track.object.taken = taken;
            (track.missed, track.misses) = (Span(0), 0);
        }
    }

    /// Forgets an object. Its number is not given again.
    pub fn remove(&mut self, number: ObjectId) {
        self.tracks.retain(|track| track.object.number != number);
    }

    /// Forgets the objects that are gone.
    pub fn forget_gone(&mut self) {
        let (vanish, tracks) = (self.settings.vanish, std::mem::take(&mut self.tracks));
        self.tracks = tracks.into_iter().filter(|track| !track.is_gone(vanish)).collect();
    }

    fn is_gone(&self, track: &Track) -> bool {
        track.is_gone(self.settings.vanish)
    }

    fn named(&mut self, name: &str) -> Result<&mut Track, Refusal> {
        let is_it = |it: &Perceived| it.name == name || it.number.0.to_string() == name;
        let track = self.tracks.iter_mut().find(|track| is_it(&track.object));
        track.ok_or_else(|| Refusal::NoObject(name.to_owned()))
    }
}
