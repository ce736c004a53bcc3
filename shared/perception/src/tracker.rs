//! The tracker: follows objects through looks, and says which there are.

use dialogue::Table;
use dialogue::time::{Span, Time};
use scene::{ObjectId, Perceived, Scene, likeliest};

use crate::estimate::{Estimate, difference, distance, place};
use crate::{Change, Detection, Frame, Look, Refusal, Sighting};

/// Objects that may yet appear.
const CANDIDATES_MAX: usize = 64;
/// Detections in one look that are used.
const SEEN_MAX: usize = 256;
/// Probability up to which a change of what an object is taken for is none.
const CHANCE_STEP: f64 = 0.1;
/// Longest time that one look which does not show an object counts for.
const MISS_MAX: Span = Span::from_ms(500);
/// Least number of looks without an object before it is gone.
const MISSES_MIN: u32 = 5;
/// Time in which a candidate must be seen often enough.
const CANDIDATE_FOR: Span = Span::from_ms(2_000);
/// Distance within which a detection is of an object whatever it is taken for, metres.
const SAME_PLACE_M: f64 = 0.03;
/// How far in the future a look may have been taken.
const AHEAD: Span = Span::from_ms(50);

/// Settings of the tracker.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// Detections after which an object is there.
    pub appear: u32,
    /// Distance up to which an object has not moved, metres.
    pub moved_m: f64,
    /// Distance up to which a detection may be of an object, metres.
    pub gate_m: f64,
    /// Time for which an object is looked for in vain before it is gone.
    pub vanish: Span,
    /// Greatest age of a look.
    pub age_max: Span,
    /// Distance from a gripper within which an object is hidden, metres.
    pub hidden_m: f64,
    /// Frames besides `base`.
    pub frames: Vec<Frame>,
}

/// What the arm hides.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Hiding {
    /// Positions of the grippers, metres.
    pub grippers: Vec<[f64; 3]>,
    /// The object that is being grasped or carried: what is seen of it says nothing.
    pub handled: Option<ObjectId>,
}

/// What is known of an object at this moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Live {
    /// Centre, metres, and yaw, radians: the best estimate.
    pub place: [f64; 4],
    /// Standard deviation of each.
    pub sd: [f64; 4],
    /// When it was last seen.
    pub seen: Time,
    /// Whether it was looked for in vain for so long that it is gone.
    pub gone: bool,
}

#[derive(Clone, Debug)]
struct Track {
    /// As it was last reported.
    object: Perceived,
    estimate: Estimate,
    /// Source and its name for the object; of those the latest.
    track: Option<(String, String)>,
    seen: Time,
    missed: Span,
    misses: u32,
}

#[derive(Clone, Debug)]
struct Candidate {
    estimate: Estimate,
    track: Option<(String, String)>,
    source: String,
    since: Time,
    seen: Time,
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
            seen: now,
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

    /// Returns the objects, each as it was last reported: places that differ by less than the settings'
    /// step are the same.
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

    /// Returns what is known of an object at this moment.
    pub fn live(&self, number: ObjectId) -> Option<Live> {
        let track = self.tracks.iter().find(|track| track.object.number == number)?;
        Some(Live {
            place: track.estimate.place,
            sd: track.estimate.variance.map(f64::sqrt),
            seen: track.seen,
            gone: self.is_gone(track),
        })
    }

    /// Notes that an object was handed to a person, or was put back in its place. One that a person has
    /// is not looked for.
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
        self.appear(Estimate::new(detection), None, now).ok_or(Refusal::Full(self.tracks.len()))
    }

    /// Takes in a look: detections of known objects, then of candidates; what it should have shown and
    /// did not was missed.
    fn look(
        &mut self,
        source: &str,
        look: &Look,
        hiding: &Hiding,
        now: Time,
    ) -> Result<(), Refusal> {
        let at = if look.at_ns == 0 { now } else { Time(look.at_ns).min(now + AHEAD) };
        let age = now.since(at);
        if age > self.settings.age_max {
            return Err(Refusal::Old(age.s()));
        }
        let before = match self.looked.iter_mut().find(|(known, _)| known == source) {
            Some((_, before)) if *before >= at => return Ok(()),
            Some((_, before)) => Some(std::mem::replace(before, at)),
            None => {
                if self.looked.len() == CANDIDATES_MAX {
                    self.looked.remove(0);
                }
                self.looked.push((source.to_owned(), at));
                None
            }
        };
        let is_near_arm = |xyz: &[f64; 3]| hiding.hides(xyz, self.settings.hidden_m);
        let handling = hiding.handled.is_some();
        let seen: Vec<&Detection> =
            look.seen.iter().filter(|it| !(handling && is_near_arm(&it.xyz))).collect();
        let shown = self.follow(source, &seen, hiding, at);
        if look.whole {
            let span = before.map_or(Span(0), |before| at.since(before)).min(MISS_MAX);
            self.miss(source, &shown, hiding, span);
        }
        self.candidates.retain(|candidate| at.since(candidate.seen) <= CANDIDATE_FOR);
        Ok(())
    }

    /// Gives each detection to an object or a candidate. Returns the numbers of the objects shown.
    fn follow(
        &mut self,
        source: &str,
        seen: &[&Detection],
        hiding: &Hiding,
        at: Time,
    ) -> Vec<ObjectId> {
        let mut left: Vec<Option<&Detection>> = seen.iter().copied().map(Some).collect();
        let mut shown: Vec<ObjectId> = Vec::new();
        for (_, track, detection) in self.pairs(source, seen) {
            let track = &mut self.tracks[track];
            let number = track.object.number;
            if shown.contains(&number) {
                continue;
            }
            let Some(detection) = left[detection].take() else { continue };
            shown.push(number);
            if hiding.handled != Some(number) {
                track.see(source, detection, self.settings.moved_m, at);
            }
        }
        for detection in left.into_iter().flatten() {
            self.see_candidate(source, detection, &mut shown, at);
        }
        shown
    }

    /// Objects and detections that may belong together, the nearest first; a source's own name for an
    /// object comes before any distance.
    fn pairs(&self, source: &str, seen: &[&Detection]) -> Vec<(f64, usize, usize)> {
        let mut pairs = Vec::new();
        for (t, track) in self.tracks.iter().enumerate().filter(|(_, it)| !it.object.taken) {
            for (d, detection) in seen.iter().enumerate() {
                let cost = match &track.track {
                    Some((of, own)) if of == source && !detection.track.is_empty() => {
                        (*own == detection.track).then_some(0.0)
                    }
                    _ => self.near(&track.estimate, detection),
                };
                pairs.extend(cost.map(|cost| (cost, t, d)));
            }
        }
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2)));
        pairs
    }

    /// Distance of a detection from an estimate, if it may be of the same object.
    fn near(&self, estimate: &Estimate, detection: &Detection) -> Option<f64> {
        let far = distance(&estimate.place, &place(detection));
        let shares = |(name, p): &(String, f64)| {
            *p > 0.0 && detection.classes.iter().any(|(other, q)| name == other && *q > 0.0)
        };
        let same = far <= SAME_PLACE_M || estimate.classes.iter().any(shares);
        (same && far <= self.settings.gate_m).then_some(far)
    }

    fn see_candidate(
        &mut self,
        source: &str,
        detection: &Detection,
        shown: &mut Vec<ObjectId>,
        at: Time,
    ) {
        let near = |candidate: &Candidate| self.near(&candidate.estimate, detection);
        let known = (0..self.candidates.len()).filter(|n| self.candidates[*n].source == source);
        let known = known.filter_map(|n| Some((near(&self.candidates[n])?, n)));
        let Some((_, n)) = known.min_by(|a, b| a.0.total_cmp(&b.0)) else {
            if self.candidates.len() < CANDIDATES_MAX {
                self.candidates.push(Candidate {
                    estimate: Estimate::new(detection),
                    track: named(source, detection),
                    source: source.to_owned(),
                    since: at,
                    seen: at,
                });
            }
            if self.settings.appear > 1 {
                return;
            }
            return self.ripen(self.candidates.len() - 1, shown, at);
        };
        let candidate = &mut self.candidates[n];
        if candidate.seen == at {
            return;
        }
        candidate.estimate.see(detection, self.settings.moved_m);
        (candidate.seen, candidate.track) = (at, named(source, detection));
        if candidate.estimate.count >= self.settings.appear {
            self.ripen(n, shown, at);
        }
    }

    /// Makes an object of a candidate: the only one of its class that has been missed since the candidate
    /// was first seen has moved there; else it is a new one.
    fn ripen(&mut self, candidate: usize, shown: &mut Vec<ObjectId>, at: Time) {
        let Candidate { estimate, track, source, since, .. } = self.candidates.remove(candidate);
        let class = likeliest(&estimate.classes).map(str::to_owned);
        let mut lost = self.tracks.iter_mut().filter(|it| {
            !it.object.taken
                && it.seen < since
                && it.object.seen_by.contains(&source)
                && likeliest(&it.estimate.classes) == class.as_deref()
        });
        let moved = match (lost.next(), lost.next()) {
            (Some(only), None) => Some(only),
            _ => None,
        };
        let number = match moved {
            Some(moved) => {
                moved.estimate.place = estimate.place;
                moved.estimate.variance = estimate.variance;
                (moved.seen, moved.missed, moved.misses) = (at, Span(0), 0);
                moved.track = track;
                moved.report(self.settings.moved_m);
                Some(moved.object.number)
            }
            None => self.appear(estimate, track, at),
        };
        if let Some(number) = number {
            if let Some(track) = self.tracks.iter_mut().find(|it| it.object.number == number) {
                track.note_source(&source);
            }
            shown.push(number);
        }
    }

    /// Gives an object a number; none if the table is full, or every number was given.
    fn appear(
        &mut self,
        estimate: Estimate,
        track: Option<(String, String)>,
        at: Time,
    ) -> Option<ObjectId> {
        let number = self.next;
        if self.tracks.len() >= dialogue::TABLE_MAX || number.0 == u16::MAX {
            return None;
        }
        self.next = ObjectId(number.0 + 1);
        let class = likeliest(&estimate.classes).unwrap_or("object");
        let [x, y, z, yaw] = estimate.place;
        let object = Perceived {
            number,
            name: format!("{class}-{}", number.0),
            classes: estimate.classes.clone(),
            attributes: estimate.attributes.clone(),
            xyz: [x, y, z],
            yaw,
            seen_by: Vec::new(),
            taken: false,
        };
        let missed = Span(0);
        self.tracks.push(Track { object, estimate, track, seen: at, missed, misses: 0 });
        Some(number)
    }

    /// Counts the objects that a look should have shown: those that its source has seen before, and that
    /// the arm does not hide.
    fn miss(&mut self, source: &str, shown: &[ObjectId], hiding: &Hiding, span: Span) {
        for track in &mut self.tracks {
            let [x, y, z, _] = track.estimate.place;
            let is_expected = track.object.seen_by.iter().any(|known| known == source)
                && !track.object.taken
                && hiding.handled != Some(track.object.number)
                && !hiding.hides(&[x, y, z], self.settings.hidden_m);
            if is_expected && !shown.contains(&track.object.number) {
                track.misses += 1;
                track.missed = Span(track.missed.0 + span.0);
            }
        }
    }
}

impl Track {
    fn see(&mut self, source: &str, detection: &Detection, moved_m: f64, at: Time) {
        self.estimate.see(detection, moved_m);
        (self.seen, self.missed, self.misses) = (at, Span(0), 0);
        if !detection.track.is_empty() {
            self.track = named(source, detection);
        }
        self.note_source(source);
        self.report(moved_m);
    }

    fn note_source(&mut self, source: &str) {
        const SOURCES_MAX: usize = 4;
        let seen_by = &mut self.object.seen_by;
        if !seen_by.iter().any(|known| known == source) && seen_by.len() < SOURCES_MAX {
            seen_by.push(source.to_owned());
        }
    }

    /// Reports the estimate, if it differs by more than a step from what was reported.
    fn report(&mut self, moved_m: f64) {
        let Estimate { classes, attributes, place: [x, y, z, yaw], .. } = &self.estimate;
        let object = &mut self.object;
        let [rx, ry, rz] = object.xyz;
        if distance(&[*x, *y, *z, 0.0], &[rx, ry, rz, 0.0]) > moved_m || moved_m == 0.0 {
            (object.xyz, object.yaw) = ([*x, *y, *z], *yaw);
        }
        let none = Vec::new();
        let changed = |(name, chances): &(String, Vec<(String, f64)>)| {
            let known = object.attributes.iter().find(|(known, _)| known == name);
            difference(chances, known.map_or(&none, |(_, known)| known)) > CHANCE_STEP
        };
        if difference(classes, &object.classes) > CHANCE_STEP || attributes.iter().any(changed) {
            (object.classes, object.attributes) = (classes.clone(), attributes.clone());
        }
    }

    fn is_gone(&self, vanish: Span) -> bool {
        !self.object.taken && self.misses >= MISSES_MIN && self.missed >= vanish
    }
}

impl Hiding {
    /// Returns whether a gripper is so near that a camera may not see the place.
    fn hides(&self, xyz: &[f64; 3], hidden_m: f64) -> bool {
        let near = |gripper: &[f64; 3]| {
            (0..2).map(|axis| (gripper[axis] - xyz[axis]).powi(2)).sum::<f64>().sqrt() < hidden_m
        };
        self.grippers.iter().any(near)
    }
}

/// The source's own name for an object, if it has one.
fn named(source: &str, detection: &Detection) -> Option<(String, String)> {
    (!detection.track.is_empty()).then(|| (source.to_owned(), detection.track.clone()))
}
