//! The tracker: follows objects through looks, and says which there are.

use scene::{ObjectId, Perceived, Scene, likeliest};
use vocabulary::Table;
use vocabulary::time::{Span, Time};

use crate::estimate::Estimate;
use crate::{Change, Detection, Frame, Look, Refusal, Sighting};
use track::{Candidate, Track};

mod looks;
mod track;

/// Detections in one look that are used.
const SEEN_MAX: usize = 256;
/// Largest change of a class probability that is ignored.
const CHANCE_STEP: f64 = 0.1;

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
            estimate: Estimate::new(&Detection {
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
    /// Why it was not used.
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
                self.look(source, &self.in_base(frame, look)?, hiding, now).map(|()| None)
            }
            Change::Add(detection) => {
                let look = Look { seen: vec![detection.clone()], ..Look::default() };
                let mut look = self.in_base(frame, &look)?;
                let detection = look.seen.pop().ok_or(Refusal::Number)?;
                self.add(&detection, file, now).map(Some)
            }
            Change::Move { object, xyz, yaw } => {
                let of = Detection { xyz: *xyz, yaw: *yaw, ..Detection::default() };
                let look = self.in_base(frame, &Look { seen: vec![of], ..Look::default() })?;
                let track = self.named(object)?;
                track.estimate.put(look.seen[0].xyz, look.seen[0].yaw);
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
        self.tracks
            .iter()
            .filter(|track| !self.is_gone(track))
            .map(|it| it.object.clone())
            .collect()
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

    /// Checks a look, and converts its places to frame `base`.
    fn in_base(&self, frame: &str, look: &Look) -> Result<Look, Refusal> {
        let known = self.settings.frames.iter().find(|known| known.name == frame);
        if frame != "base" && known.is_none() {
            return Err(Refusal::Frame(frame.to_owned()));
        }
        if !look.seen.iter().all(Detection::is_sound) {
            return Err(Refusal::Number);
        }
        let mut look = look.clone();
        look.seen.truncate(SEEN_MAX);
        for detection in &mut look.seen {
            if let Some(frame) = known {
                (detection.xyz, detection.yaw) = frame.to_base(detection.xyz, detection.yaw);
            }
        }
        Ok(look)
    }

    fn add(&mut self, detection: &Detection, file: &Scene, now: Time) -> Result<ObjectId, Refusal> {
        let class = likeliest(&detection.classes).unwrap_or_default();
        if file.object_named(class).is_none() {
            return Err(Refusal::NoClass(class.to_owned()));
        }
        check_values(detection, file)?;
        self.appear(Estimate::new(detection), None, now).ok_or(Refusal::Full(self.tracks.len()))
    }
}

/// Checks that the scene file has the attributes and values. Others, from cameras, do not count.
fn check_values(detection: &Detection, file: &Scene) -> Result<(), Refusal> {
    for (name, values) in &detection.attributes {
        let Some(k) = file.attribute_named(name) else {
            let known = listed(file.attributes().iter().map(|attribute| attribute.name.as_str()));
            return Err(Refusal::NoAttribute(name.clone(), known));
        };
        if let Some((value, _)) = values.iter().find(|(v, _)| file.value_named(k, v).is_none()) {
            let known = file.attributes()[k.index()].values.iter().map(|value| value.name.as_str());
            return Err(Refusal::NoValue(name.clone(), value.clone(), listed(known)));
        }
    }
    Ok(())
}

fn listed<'a>(names: impl Iterator<Item = &'a str>) -> String {
    names.collect::<Vec<_>>().join(", ")
}
