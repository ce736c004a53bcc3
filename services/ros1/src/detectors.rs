//! Messages of detectors as sightings for the group.

use crate::guarded;
use crate::settings::Ros1Objects;
use crate::subscription::{Sink, Subscription};
use crate::types as ros;
use ::ros::clock::StampClock;
use ::ros::detector::{Detector, Hypothesis, Reported};
use ::ros::detectors::Labels;
use ::ros::wire::{Message, RosTime};
use config::Settings;
use messages::Sighting;
use perception::Frame;
use service::Time;
use service::client::random_number;
use std::sync::{Arc, Mutex};

/// A message of a detector.
pub trait Detections: Message {
    /// Identifiers stand for classes, or else for markers.
    const OF_CLASSES: bool;

    /// When the image was taken, in the detector's time.
    fn stamp(&self) -> RosTime;

    /// What the image shows, for that detector.
    fn reported(&self, detector: &Detector) -> Vec<Reported>;
}

impl Detections for ros::Detection3DArray {
    const OF_CLASSES: bool = true;

    fn stamp(&self) -> RosTime {
        first_stamp([&self.header].into_iter().chain(self.detections.iter().map(|it| &it.header)))
    }

    fn reported(&self, _: &Detector) -> Vec<Reported> {
        let one = |detection: &ros::Detection3D| Reported {
            frame: first_frame([&self.header, &detection.header]),
            track: String::new(),
            hypotheses: detection.results.iter().map(hypothesis).collect(),
            center: Some((&detection.bbox.center).into()),
        };
        self.detections.iter().map(one).collect()
    }
}

impl Detections for ros::AprilTagDetectionArray {
    const OF_CLASSES: bool = false;

    fn stamp(&self) -> RosTime {
        first_stamp(
            [&self.header].into_iter().chain(self.detections.iter().map(|it| &it.pose.header)),
        )
    }

    fn reported(&self, detector: &Detector) -> Vec<Reported> {
        let one = |detection: &ros::AprilTagDetection| {
            let ros::PoseWithCovariance { pose: own, covariance } = &detection.pose.pose;
            // A bundle has the numbers of all its tags: one with a label stands for it.
            let ids: Vec<String> = detection.id.iter().map(i32::to_string).collect();
            let id = ids.iter().find(|id| detector.knows(id)).or(ids.first())?;
            let frame = first_frame([&detection.pose.header, &self.header]);
            Some(Reported::marker(&frame, id, own.into(), covariance.0))
        };
        self.detections.iter().filter_map(one).collect()
    }
}

impl Detections for ros::AlvarMarkers {
    const OF_CLASSES: bool = false;

    fn stamp(&self) -> RosTime {
        first_stamp([&self.header].into_iter().chain(self.markers.iter().map(|it| &it.header)))
    }

    fn reported(&self, _: &Detector) -> Vec<Reported> {
        let one = |marker: &ros::AlvarMarker| {
            // The outer headers are often empty.
            let frame = first_frame([&marker.header, &marker.pose.header, &self.header]);
            let unknown = [0.0; 36];
            Reported::marker(&frame, &marker.id.to_string(), (&marker.pose.pose).into(), unknown)
        };
        self.markers.iter().map(one).collect()
    }
}

/// Returns the first stamp that is set.
fn first_stamp<'a>(mut headers: impl Iterator<Item = &'a ros::Header>) -> RosTime {
    headers.find_map(|it| it.stamp.ns().map(|_| it.stamp)).unwrap_or_default()
}

/// Returns the first frame that is set.
fn first_frame<const N: usize>(headers: [&ros::Header; N]) -> String {
    let mut frames = headers.iter().map(|header| &header.frame_id);
    frames.find(|frame| !frame.is_empty()).cloned().unwrap_or_default()
}

fn hypothesis(result: &ros::ObjectHypothesisWithPose) -> Hypothesis {
    Hypothesis {
        id: result.id.to_string(),
        score: result.score,
        pose: (&result.pose.pose).into(),
        covariance: result.pose.covariance.0,
    }
}

/// Takes the sightings of the subscriptions.
pub type Take = Arc<dyn Fn(Sighting) + Send + Sync>;

/// Returns the subscriptions of the detectors that are configured.
pub fn subscriptions(
    objects: &Ros1Objects,
    settings: &Settings,
    take: &Take,
) -> Vec<Arc<Subscription>> {
    let Ros1Objects { detections, apriltags, ar_markers, labels } = objects;
    let frames = &settings.group.perception.tracker.frames;
    let all = [
        detections
            .as_ref()
            .map(|topic| subscription::<ros::Detection3DArray>(topic, labels, frames, take)),
        apriltags
            .as_ref()
            .map(|topic| subscription::<ros::AprilTagDetectionArray>(topic, labels, frames, take)),
        ar_markers
            .as_ref()
            .map(|topic| subscription::<ros::AlvarMarkers>(topic, labels, frames, take)),
    ];
    all.into_iter().flatten().map(Arc::new).collect()
}

fn subscription<M: Detections + 'static>(
    topic: &str,
    labels: &Labels,
    frames: &[Frame],
    take: &Take,
) -> Subscription {
    let Labels { classes, markers } = labels;
    let labels = if M::OF_CLASSES { classes } else { markers };
    let detector = Arc::new(Mutex::new(Detector::new(topic, labels, None, frames)));
    let take = Arc::clone(take);
    let name = topic.to_owned();
    let sink = move || -> Sink {
        let (mut clock, detector) = (StampClock::default(), Arc::clone(&detector));
        let (take, topic) = (Arc::clone(&take), name.clone());
        Box::new(move |bytes, arrival| {
            let message = M::from_bytes(bytes)?;
            let made = clock.map(message.stamp().ns(), arrival);
            let mut detector = guarded(&detector);
            take(sighting(&mut detector, &message, made));
            report_unused(&topic, &mut detector);
            Ok(())
        })
    };
    Subscription::new::<M>(topic, sink).of_large_messages()
}

fn sighting(detector: &mut Detector, message: &impl Detections, made: Time) -> Sighting {
    let reported = message.reported(detector);
    // Zero would be the time of its arrival.
    detector.look(random_number(), made.ns().max(1), &reported)
}

fn report_unused(topic: &str, detector: &mut Detector) {
    for unused in detector.take_unused() {
        tracing::warn!(topic, "{unused}");
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests {
    use super::*;
    use ::ros::detector::Label;
    use ::ros::wire::Field;
    use perception::{Change, Detection, Look};

    /// Bytes that genpy has written.
    fn bytes(hex: &str) -> Vec<u8> {
        let digits: Vec<char> = hex.chars().filter(char::is_ascii_hexdigit).collect();
        let byte = |pair: &[char]| u8::from_str_radix(&pair.iter().collect::<String>(), 16);
        digits.chunks(2).map(|pair| byte(pair).unwrap()).collect()
    }

    fn detector(labels: &[(&str, &str)]) -> Detector {
        let label = |(id, object): &(&str, &str)| Label {
            id: (*id).to_owned(),
            object: (*object).to_owned(),
            ..Label::default()
        };
        let labels: Vec<_> = labels.iter().map(label).collect();
        let lens = Frame { name: "lens".to_owned(), xyz: [0.0, 0.0, 1.0], rpy: [0.0; 3] };
        Detector::new("/camera", &labels, None, &[lens])
    }

    /// The look that a message becomes, after the check that its stamp is that of the fixture.
    fn look<M: Detections>(detector: &mut Detector, hex: &str) -> Look {
        let message = M::from_bytes(&bytes(hex)).unwrap();
        assert_eq!(message.stamp(), RosTime { secs: 1000, nsecs: 250_000_000 });
        let sighting = sighting(detector, &message, Time(5));
        assert_eq!((sighting.source.as_str(), sighting.frame.as_str()), ("/camera", "base"));
        match sighting.change {
            Change::Look(look) => look,
            other => panic!("expected a look, found {other:?}"),
        }
    }

    fn assert_at(detection: &Detection, x: f64) {
        let [dx, dy, dz] = [x, 0.1, 1.2].map(|n| (n * 1e9).round());
        assert_eq!(detection.xyz.map(|n| (n * 1e9).round()), [dx, dy, dz]);
        assert!((detection.yaw - 2.0 * 0.6_f64.atan2(0.8)).abs() < 1e-9, "{detection:?}");
    }

    #[test]
    fn detections_of_rospy_are_read_with_scores_poses_and_covariances() {
        let mut detector = detector(&[("3", "white"), ("5", "clear")]);
        let hex = include_str!("../../../tests/fixtures/ros1/detections.hex");
        let look = look::<ros::Detection3DArray>(&mut detector, hex);
        assert_eq!((look.at_ns, look.whole, look.seen.len()), (5, true, 2));
        assert_at(&look.seen[0], 0.5);
        assert_at(&look.seen[1], 0.4);
        assert_eq!(look.seen[0].classes, [("white".to_owned(), 0.7)]);
        assert_eq!(look.seen[1].classes, [("clear".to_owned(), 0.9)]);
        assert_eq!(look.seen[0].variances, [0.01, 0.02, 0.03, 0.04]);
        assert_eq!(detector.counts().unknown, 1, "class -4");
    }

    #[test]
    fn bundle_of_apriltags_is_that_of_its_tag_with_a_label() {
        let mut detector = detector(&[("9", "metal")]);
        let hex = include_str!("../../../tests/fixtures/ros1/apriltags.hex");
        let look = look::<ros::AprilTagDetectionArray>(&mut detector, hex);
        let [seen] = look.seen.as_slice() else { panic!("{look:?}") };
        assert_at(seen, 0.5);
        assert_eq!((seen.track.as_str(), &seen.classes), ("9", &vec![("metal".to_owned(), 1.0)]));
        assert_eq!(seen.variances, [0.01, 0.02, 0.03, 0.04]);
    }

    #[test]
    fn headers_of_ar_markers_count_where_the_outer_one_is_empty() {
        let mut detector = detector(&[("11", "white")]);
        let hex = include_str!("../../../tests/fixtures/ros1/ar_markers.hex");
        let look = look::<ros::AlvarMarkers>(&mut detector, hex);
        let [seen] = look.seen.as_slice() else { panic!("{look:?}") };
        assert_at(seen, 0.5);
        assert_eq!((seen.track.as_str(), seen.variances), ("11", [0.0; 4]));
    }

    #[test]
    fn message_that_is_cut_off_is_rejected() {
        let whole = bytes(include_str!("../../../tests/fixtures/ros1/detections.hex"));
        for end in 0..whole.len() {
            assert!(ros::Detection3DArray::from_bytes(&whole[..end]).is_err(), "cut at {end}");
        }
        let mut lies = u32::MAX.to_le_bytes().to_vec();
        lies.extend([0; 8]);
        assert!(::ros::wire::Skipped::read(&mut lies.as_slice()).is_err());
    }

    #[test]
    fn nothing_seen_is_an_empty_look() {
        let (mut detector, empty) = (detector(&[]), ros::AlvarMarkers::default());
        let sighting = sighting(&mut detector, &empty, Time(0));
        let look = Look { at_ns: 1, whole: true, seen: Vec::new() };
        assert_eq!((sighting.frame.as_str(), sighting.change), ("base", Change::Look(look)));
    }
}
