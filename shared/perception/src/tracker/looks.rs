//! Looks: matching of detections to objects, new objects, and missed ones.

use scene::{ObjectId, Perceived, Scene, likeliest};
use vocabulary::time::{Span, Time};

use super::track::{Candidate, Track, named};
use super::{Hiding, Tracker};
use crate::estimate::{Estimate, distance, place};
use crate::{Detection, Look, Refusal};

/// Objects that may yet appear.
const CANDIDATES_MAX: usize = 64;
/// Longest time that one look which does not show an object counts for.
const MISS_MAX: Span = Span::from_ms(500);
/// Time in which a candidate must be seen often enough.
const CANDIDATE_FOR: Span = Span::from_ms(2_000);
/// Distance within which a detection is of an object whatever it is taken for, metres.
const SAME_PLACE_M: f64 = 0.03;
/// Least probability of a class that a detection may confirm.
const CLASS_MIN: f64 = 0.01;
/// How far in the future a look may have been taken.
const AHEAD: Span = Span::from_ms(50);

impl Tracker {
    /// Processes a look: detections of known objects, then of candidates; expected objects that it
    /// did not show were missed.
    pub(super) fn look(
        &mut self,
        source: &str,
        look: &Look,
        file: &Scene,
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
        let shown = self.follow(source, (&seen, file), hiding, at);
        if look.whole {
            let span = before.map_or(Span(0), |before| at.since(before)).min(MISS_MAX);
            self.miss(source, &shown, hiding, span);
        }
        self.drop_candidates(at);
        Ok(())
    }

    /// Drops the candidates not seen again, and those replaced by a sighting of a known object.
    fn drop_candidates(&mut self, at: Time) {
        let moved_m = self.settings.moved_m;
        let is_known = |candidate: &Candidate| {
            let class = likeliest(&candidate.estimate.classes);
            self.tracks.iter().any(|track| {
                track.stood == at
                    && likeliest(&track.estimate.classes) == class
                    && distance(&track.estimate.place, &candidate.estimate.place) <= moved_m
            })
        };
        let is_kept =
            |it: &Candidate| it.seen == at || at.since(it.seen) <= CANDIDATE_FOR && !is_known(it);
        self.candidates.retain(is_kept);
    }

    /// Gives each detection to an object or a candidate. Returns the numbers of the objects shown.
    fn follow(
        &mut self,
        source: &str,
        (seen, file): (&[&Detection], &Scene),
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
                track.see(source, (detection, file), self.settings.moved_m, at);
            }
        }
        for detection in left.into_iter().flatten() {
            self.see_candidate(source, (detection, file), &mut shown, at);
        }
        shown
    }

    /// Objects and detections that may belong together, the nearest first; a source's own name for
    /// an object comes before any distance.
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
            *p >= CLASS_MIN && detection.classes.iter().any(|(other, q)| name == other && *q > 0.0)
        };
        let same = far <= SAME_PLACE_M || estimate.classes.iter().any(shares);
        (same && far <= self.settings.gate_m).then_some(far)
    }

    fn see_candidate(
        &mut self,
        source: &str,
        (detection, file): (&Detection, &Scene),
        shown: &mut Vec<ObjectId>,
        at: Time,
    ) {
        let near = |candidate: &Candidate| self.near(&candidate.estimate, detection);
        let known = (0..self.candidates.len()).filter(|n| self.candidates[*n].source == source);
        let known = known.filter_map(|n| Some((near(&self.candidates[n])?, n)));
        let Some((_, n)) = known.min_by(|a, b| a.0.total_cmp(&b.0)) else {
            if self.candidates.len() < CANDIDATES_MAX {
                let (estimate, track) = (Estimate::new(detection, file), named(source, detection));
                let (source, since, seen, beside) = (source.to_owned(), at, at, shown.clone());
                let new = Candidate { estimate, track, source, since, seen, beside };
                self.candidates.push(new);
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
        candidate.note_beside(shown);
        candidate.estimate.see(detection, file, self.settings.moved_m);
        (candidate.seen, candidate.track) = (at, named(source, detection));
        if candidate.estimate.count >= self.settings.appear {
            self.ripen(n, shown, at);
        }
    }

    /// Makes an object of a candidate: the only one of its class that was neither seen in its place
    /// since the candidate was first seen, nor beside it, has moved there; else it is a new one.
    fn ripen(&mut self, candidate: usize, shown: &mut Vec<ObjectId>, at: Time) {
        let Candidate { estimate, track, source, since, beside, .. } =
            self.candidates.remove(candidate);
        let class = likeliest(&estimate.classes).map(str::to_owned);
        let mut lost = self.tracks.iter_mut().filter(|it| {
            !it.object.taken
                && it.stood < since
                && !beside.contains(&it.object.number)
                && it.object.seen_by.contains(&source)
                && likeliest(&it.estimate.classes) == class.as_deref()
        });
        let (first, second) = (lost.next(), lost.next());
        let moved = first.filter(|_| second.is_none());
        let number = match moved {
            Some(moved) => {
                moved.estimate.move_to(&estimate);
                (moved.seen, moved.stood, moved.missed, moved.misses) = (at, at, Span(0), 0);
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

    /// Gives an object a number; `None` if the table is full, or all numbers are used.
    pub(super) fn appear(
        &mut self,
        estimate: Estimate,
        track: Option<(String, String)>,
        at: Time,
    ) -> Option<ObjectId> {
        let number = self.next;
        if self.tracks.len() >= vocabulary::TABLE_MAX || number.0 == u16::MAX {
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
        let (seen, stood, missed) = (at, at, Span(0));
        self.tracks.push(Track { object, estimate, track, seen, stood, missed, misses: 0 });
        Some(number)
    }

    /// Counts the objects that a look should have shown: those that its source has seen before, and
    /// that the arm does not hide.
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

impl Hiding {
    /// Returns whether a gripper is so near that a camera may not see the place.
    fn hides(&self, xyz: &[f64; 3], hidden_m: f64) -> bool {
        let near = |gripper: &[f64; 3]| {
            (0..2).map(|axis| (gripper[axis] - xyz[axis]).powi(2)).sum::<f64>().sqrt() < hidden_m
        };
        self.grippers.iter().any(near)
    }
}
