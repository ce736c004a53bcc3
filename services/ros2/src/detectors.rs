//! Messages of detectors as sightings for the group.

use crate::clock::SystemClock;
use crate::settings::Ros2Objects;
use crate::types::{
    AlvarMarker, AlvarMarkers, Detection3D, Detection3DArray, Header, TfMessage, Time,
};
use config::Settings;
use messages::Sighting;
use ros::detector::{Detector, Hypothesis, Reported, UnusedCounts};
use service::client::random_number;

/// A message that holds all that one image shows.
pub trait Detections {
    /// When the image was taken, system clock.
    fn stamp(&self) -> Time;

    /// What the image shows.
    fn reported(&self) -> Vec<Reported>;
}

impl Detections for Detection3DArray {
    fn stamp(&self) -> Time {
        first_stamp(&self.header, self.detections.iter().map(|it| &it.header))
    }

    fn reported(&self) -> Vec<Reported> {
        let one = |detection: &Detection3D| Reported {
            frame: first_frame([&self.header, &detection.header]),
            track: detection.id.clone(),
            hypotheses: (detection.results.iter())
                .map(|result| Hypothesis {
                    id: result.hypothesis.class_id.clone(),
                    score: result.hypothesis.score,
                    pose: (&result.pose.pose).into(),
                    covariance: result.pose.covariance.0,
                })
                .collect(),
            center: Some((&detection.bbox.center).into()),
        };
        self.detections.iter().map(one).collect()
    }
}

impl Detections for AlvarMarkers {
    fn stamp(&self) -> Time {
        first_stamp(&self.header, self.markers.iter().map(|it| &it.header))
    }

    fn reported(&self) -> Vec<Reported> {
        let one = |marker: &AlvarMarker| {
            let frame = first_frame([&marker.header, &marker.pose.header, &self.header]);
            let unknown = [0.0; 36];
            Reported::marker(&frame, &marker.id.to_string(), (&marker.pose.pose).into(), unknown)
        };
        self.markers.iter().map(one).collect()
    }
}

/// Returns the first stamp that is set.
fn first_stamp<'a>(outer: &'a Header, inner: impl Iterator<Item = &'a Header>) -> Time {
    let mut stamps = [outer].into_iter().chain(inner).map(|header| header.stamp);
    stamps.find(|stamp| *stamp != Time::default()).unwrap_or_default()
}

/// Returns the first frame that is set.
fn first_frame<const N: usize>(headers: [&Header; N]) -> String {
    let mut frames = headers.iter().map(|header| &header.frame_id);
    frames.find(|frame| !frame.is_empty()).cloned().unwrap_or_default()
}

/// Time of a stamp for a sighting; 0 where it is not set.
fn at_ns(stamp: Time, clock: SystemClock) -> u64 {
    clock.monotonic(stamp).map_or(0, |at| at.ns())
}

/// The detector of one topic.
#[derive(Clone, Debug)]
pub struct TopicDetector {
    topic: String,
    detector: Detector,
}

impl TopicDetector {
    /// Converts a message.
    pub fn look(&mut self, message: &impl Detections, clock: SystemClock) -> Sighting {
        let at_ns = at_ns(message.stamp(), clock);
        let sighting = self.detector.look(random_number(), at_ns, &message.reported());
        self.report_unused();
        sighting
    }

    /// Converts the frames that belong to markers.
    pub fn markers(&mut self, message: &TfMessage, clock: SystemClock) -> Vec<Sighting> {
        let mut sightings = Vec::new();
        for transform in &message.transforms {
            let Header { stamp, frame_id } = &transform.header;
            let id = transform.child_frame_id.trim_start_matches('/');
            let marker = Reported::marker(frame_id, id, (&transform.transform).into(), [0.0; 36]);
            sightings.extend(self.detector.marker(random_number(), at_ns(*stamp, clock), &marker));
        }
        self.report_unused();
        sightings
    }

    fn report_unused(&mut self) {
        for unused in self.detector.take_unused() {
            tracing::warn!(topic = self.topic, "{unused}");
        }
    }
}

/// The detectors of the settings.
#[derive(Clone, Debug)]
pub struct Detectors {
    /// Of `vision_msgs/Detection3DArray`.
    pub classes: TopicDetector,
    /// Of `ar_track_alvar_msgs/AlvarMarkers`.
    pub ar_markers: TopicDetector,
    /// Of `tf2_msgs/TFMessage`.
    pub frames: TopicDetector,
}

impl Detectors {
    /// Returns the detectors, also of topics that are not configured.
    pub fn new(objects: &Ros2Objects, settings: &Settings) -> Self {
        let Ros2Objects { detections, ar_markers, tf, labels } = objects;
        let frames = &settings.group.perception.tracker.frames;
        let of = |topic: &Option<String>, labels, scene| {
            let topic = topic.clone().unwrap_or_default();
            TopicDetector { detector: Detector::new(&topic, labels, scene, frames), topic }
        };
        Self {
            classes: of(detections, &labels.classes, Some(settings.scene.clone())),
            ar_markers: of(ar_markers, &labels.markers, None),
            frames: of(tf, &labels.markers, None),
        }
    }

    /// Returns how much was not used so far.
    pub fn unused(&self) -> UnusedCounts {
        let Self { classes, ar_markers, frames } = self;
        let counts = [classes, ar_markers, frames].map(|it| it.detector.counts());
        let sum = |count: fn(&UnusedCounts) -> u64| counts.iter().map(count).sum();
        UnusedCounts { unknown: sum(|it| it.unknown), poses: sum(|it| it.poses) }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
pub(crate) mod tests;
