//! One object that is followed, and one that may yet be.

use scene::{ObjectId, Perceived, Scene};
use vocabulary::time::{Span, Time};

use crate::Detection;
use crate::estimate::{Estimate, differ, distance};

/// Least number of looks without an object before it is gone.
const MISSES_MIN: u32 = 5;

#[derive(Clone, Debug)]
pub(super) struct Track {
    /// The object as last reported.
    pub(super) object: Perceived,
    pub(super) estimate: Estimate,
    /// Source and its name for the object; of those the latest.
    pub(super) track: Option<(String, String)>,
    pub(super) seen: Time,
    /// Time of the last sighting at the estimated place.
    pub(super) stood: Time,
    pub(super) missed: Span,
    pub(super) misses: u32,
}

#[derive(Clone, Debug)]
pub(super) struct Candidate {
    pub(super) estimate: Estimate,
    pub(super) track: Option<(String, String)>,
    pub(super) source: String,
    pub(super) since: Time,
    pub(super) seen: Time,
    /// Objects that a look showed beside this one, so that it is another.
    pub(super) beside: Vec<ObjectId>,
}

impl Candidate {
    pub(super) fn note_beside(&mut self, shown: &[ObjectId]) {
        for number in shown {
            if !self.beside.contains(number) {
                self.beside.push(*number);
            }
        }
    }
}

impl Track {
    pub(super) fn see(
        &mut self,
        source: &str,
        (detection, file): (&Detection, &Scene),
        moved_m: f64,
        at: Time,
    ) {
        if self.estimate.see(detection, file, moved_m) {
            self.stood = at;
        }
        (self.seen, self.missed, self.misses) = (at, Span(0), 0);
        if !detection.track.is_empty() {
            self.track = named(source, detection);
        }
        self.note_source(source);
        self.report(moved_m);
    }

    pub(super) fn note_source(&mut self, source: &str) {
        const SOURCES_MAX: usize = 4;
        let seen_by = &mut self.object.seen_by;
        if !seen_by.iter().any(|known| known == source) && seen_by.len() < SOURCES_MAX {
            seen_by.push(source.to_owned());
        }
    }

    /// Reports the estimate, if it differs by more than a step from the last report.
    pub(super) fn report(&mut self, moved_m: f64) {
        let Estimate { classes, attributes, place: [x, y, z, yaw], .. } = &self.estimate;
        let object = &mut self.object;
        let [rx, ry, rz] = object.xyz;
        if distance(&[*x, *y, *z, 0.0], &[rx, ry, rz, 0.0]) > moved_m || moved_m == 0.0 {
            (object.xyz, object.yaw) = ([*x, *y, *z], *yaw);
        }
        let none = Vec::new();
        let changed = |(name, chances): &(String, Vec<(String, f64)>)| {
            let known = object.attributes.iter().find(|(known, _)| known == name);
            differ(chances, known.map_or(&none, |(_, known)| known))
        };
        if differ(classes, &object.classes) || attributes.iter().any(changed) {
            (object.classes, object.attributes) = (classes.clone(), attributes.clone());
        }
    }

    pub(super) fn is_gone(&self, vanish: Span) -> bool {
        !self.object.taken && self.misses >= MISSES_MIN && self.missed >= vanish
    }
}

/// The source's own name for an object, if it has one.
pub(super) fn named(source: &str, detection: &Detection) -> Option<(String, String)> {
    (!detection.track.is_empty()).then(|| (source.to_owned(), detection.track.clone()))
}
