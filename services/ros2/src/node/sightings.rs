//! Objects from detectors, for the group.

use super::Node;
use crate::clock::SystemClock;
use messages::Sighting;

impl Node {
    /// Takes the messages of detectors, and passes them on as sightings.
    pub(super) fn on_detections(&mut self) {
        let Self { dds, detectors, counters, .. } = self;
        let clock = SystemClock::now();
        let mut sightings = Vec::new();
        let mut more = false;
        if let Some(inlet) = &dds.detections {
            more |= inlet.drain(&mut counters.unreadable, |message, _| {
                sightings.push(detectors.classes.look(&message, clock));
            });
        }
        if let Some(inlet) = &dds.ar_markers {
            more |= inlet.drain(&mut counters.unreadable, |message, _| {
                sightings.push(detectors.ar_markers.look(&message, clock));
            });
        }
        if let Some(inlet) = &dds.marker_frames {
            more |= inlet.drain(&mut counters.unreadable, |message, _| {
                sightings.extend(detectors.frames.markers(&message, clock));
            });
        }
        self.has_more |= more;
        sightings.iter().for_each(|sighting| self.pass_on(sighting));
        let unused = self.detectors.unused();
        (self.counters.unknown_ids, self.counters.without_pose) = (unused.unknown, unused.poses);
    }

    fn pass_on(&mut self, sighting: &Sighting) {
        match self.group.sightings.send(sighting) {
            Ok(()) => self.counters.sightings += 1,
            Err(error) => {
                self.counters.dropped += 1;
                tracing::debug!(%error, "a sighting is dropped");
            }
        }
    }
}
