//! Messages of detectors as sightings: the object behind an identifier, and its centre in frame
//! `base`.
//!
//! Detectors name classes and markers, state poses with all three angles in the frame of a camera,
//! and leave covariances at zero. All of that is converted here, so that a [`Sighting`] has the
//! names of the scene file and upright objects in frame `base`.

use perception::{Change, Detection, Frame, Look, Rotation, Sighting};
use scene::Scene;

use crate::rotation::{followed, of_quaternion, variances, yaw_of};

/// Most unknown identifiers that are remembered, so that each is reported once.
const UNKNOWN_MAX: usize = 64;

/// Meaning of a detector's identifier.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Label {
    /// Class, number of a marker, or name of a marker's frame.
    pub id: String,
    /// Name of an object in the scene file.
    pub object: String,
    /// Centre of the object in the frame whose pose the detector reports, metres.
    pub xyz: [f64; 3],
    /// Rotation of the object in that frame: roll, pitch and yaw about fixed axes, radians.
    pub rpy: [f64; 3],
}

/// Position, metres, and rotation, a quaternion x, y, z, w.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pose {
    /// Position.
    pub position: [f64; 3],
    /// Rotation; a quaternion of length 0 counts as none.
    pub orientation: [f64; 4],
}

/// A possible object behind a detection.
#[derive(Clone, Debug, PartialEq)]
pub struct Hypothesis {
    /// Identifier of the class or marker.
    pub id: String,
    /// Score, 0 to 1.
    pub score: f64,
    /// Pose of the object if it is that; a position of exactly zero counts as not stated.
    pub pose: Pose,
    /// Covariance of the position, metres, and of rotations about the axes, radians, row by row;
    /// zero where it is not stated.
    pub covariance: [f64; 36],
}

/// One object as a detector reports it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reported {
    /// Frame of the poses; a leading slash is ignored.
    pub frame: String,
    /// Identifier under which the detector follows this object; empty if it has none.
    pub track: String,
    /// Possible objects.
    pub hypotheses: Vec<Hypothesis>,
    /// Pose of the object's centre, if it is stated in addition to those of the hypotheses.
    pub center: Option<Pose>,
}

/// Why part of a message is not used.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Unused {
    /// No label has the identifier.
    #[error("unknown identifier `{0}`; help: add it to the detector's classes or markers")]
    Unknown(String),
    /// A number of the pose is not finite, or no pose is stated.
    #[error("a detection of `{0}` without a pose of finite numbers")]
    Pose(String),
}

/// Counts of unused detections.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct UnusedCounts {
    /// Identifiers that no label has.
    pub unknown: u64,
    /// Detections without a usable pose.
    pub poses: u64,
}

/// Converts the messages of one topic.
#[derive(Clone, Debug)]
pub struct Detector {
    source: String,
    labels: Vec<Label>,
    /// The scene whose names and words need no label.
    scene: Option<Scene>,
    frames: Vec<Frame>,
    counts: UnusedCounts,
    reported: Vec<String>,
    /// Unused detections since [`take_unused`](Self::take_unused).
    unused: Vec<Unused>,
}

impl Detector {
    /// Converts messages of the source `source`, e.g. a topic. Identifiers that `scene` knows, by name
    /// or by its words, need no label; `frames` are those besides `base`.
    pub fn new(source: &str, labels: &[Label], scene: Option<Scene>, frames: &[Frame]) -> Self {
        Self {
            source: source.to_owned(),
            labels: labels.to_vec(),
            scene,
            frames: frames.to_vec(),
            counts: UnusedCounts::default(),
            reported: Vec::new(),
            unused: Vec::new(),
        }
    }

    /// Converts all that one image shows. `at_ns` is the time of its exposure on the monotonic
    /// clock, 0 if that is not known.
    ///
    /// A message with a pose in an unknown frame becomes an empty look in that frame, which the
    /// policy refuses with its reason.
    pub fn look(&mut self, key: u64, at_ns: u64, reported: &[Reported]) -> Sighting {
        let mut sighting = Sighting {
            key,
            source: self.source.clone(),
            frame: "base".to_owned(),
            change: Change::Look(Look::default()),
        };
        let mut look = Look { at_ns, whole: true, seen: Vec::new() };
        let poses = self.counts.poses;
        for one in reported {
            match self.detection(one) {
                Ok(detection) => look.seen.extend(detection),
                Err(frame) => {
                    (sighting.frame, look.seen) = (frame, Vec::new());
                    break;
                }
            }
        }
        // What has no usable pose, or no class, may be any object.
        let is_named = |one: &Reported| one.hypotheses.iter().any(|it| it.score > 0.0);
        look.whole &= self.counts.poses == poses && reported.iter().all(is_named);
        sighting.change = Change::Look(look);
        sighting
    }

    /// Converts a single marker, whose absence says nothing. Returns `None` if no label has its
    /// identifier: transforms of all kinds share a topic.
    pub fn marker(&mut self, key: u64, at_ns: u64, reported: &Reported) -> Option<Sighting> {
        let hypothesis = reported.hypotheses.first().filter(|it| self.knows(&it.id))?;
        let mut sighting = self.look(key, at_ns, std::slice::from_ref(reported));
        // Messages about several markers may have the same time, so each is a source of its own.
        sighting.source = format!("{} {}", self.source, hypothesis.id);
        if let Change::Look(look) = &mut sighting.change {
            look.whole = false;
        }
        Some(sighting)
    }

    /// Returns whether a label has the identifier.
    pub fn knows(&self, id: &str) -> bool {
        self.labels.iter().any(|label| label.id == id)
    }

    /// Returns how much was not used so far.
    pub fn counts(&self) -> UnusedCounts {
        self.counts
    }

    /// Returns the detections unused since the last call, each unknown identifier only once.
    pub fn take_unused(&mut self) -> Vec<Unused> {
        std::mem::take(&mut self.unused)
    }

    /// Returns the detection, `None` if it cannot be used.
    ///
    /// # Errors
    /// The frame is not known.
    fn detection(&mut self, reported: &Reported) -> Result<Option<Detection>, String> {
        let mut known: Vec<(Label, &Hypothesis)> = Vec::new();
        let mut unknown_score = 0.0_f64;
        for hypothesis in &reported.hypotheses {
            match self.label(&hypothesis.id) {
                Some(label) if hypothesis.score > 0.0 => known.push((label, hypothesis)),
                Some(_) => {}
                None => {
                    self.note_unknown(&hypothesis.id);
                    unknown_score = unknown_score.max(hypothesis.score);
                }
            }
        }
        let classes = classes(&known);
        // Less likely objects are no substitute for an unknown one.
        let is_likeliest = classes.iter().any(|(_, p)| *p >= unknown_score.min(1.0));
        let best = known.iter().rev().max_by(|a, b| a.1.score.total_cmp(&b.1.score));
        let Some((label, hypothesis)) = best.filter(|_| is_likeliest) else { return Ok(None) };
        let frame = self.frame(&reported.frame)?;
        let stated = |pose: &Pose| pose.position != [0.0; 3];
        let pose = Some(hypothesis.pose).filter(stated).or(reported.center.filter(stated));
        let detection = pose.map(|pose| Detection {
            track: reported.track.clone(),
            classes,
            ..placed(&frame, &pose, label, &hypothesis.covariance)
        });
        let detection = detection.filter(Detection::is_sound);
        if detection.is_none() {
            self.counts.poses += 1;
            if self.counts.poses == 1 {
                self.unused.push(Unused::Pose(hypothesis.id.clone()));
            }
        }
        Ok(detection)
    }

    fn label(&self, id: &str) -> Option<Label> {
        let own = self.labels.iter().find(|label| label.id == id).cloned();
        own.or_else(|| {
            let scene = self.scene.as_ref()?;
            let (id, object) = (id.to_owned(), id.to_owned());
            let label = Label { id, object, xyz: [0.0; 3], rpy: [0.0; 3] };
            perception::is_known(&label.id, scene).then_some(label)
        })
    }

    fn note_unknown(&mut self, id: &str) {
        self.counts.unknown += 1;
        if self.reported.len() < UNKNOWN_MAX && !self.reported.iter().any(|known| known == id) {
            self.reported.push(id.to_owned());
            self.unused.push(Unused::Unknown(id.to_owned()));
        }
    }

    fn frame(&self, name: &str) -> Result<Frame, String> {
        let name = name.trim_start_matches('/');
        if name == "base" {
            return Ok(Frame { name: name.to_owned(), xyz: [0.0; 3], rpy: [0.0; 3] });
        }
        self.frames.iter().find(|frame| frame.name == name).cloned().ok_or_else(|| name.to_owned())
    }
}

/// Probabilities of the objects: the scores, those of one object together.
fn classes(known: &[(Label, &Hypothesis)]) -> Vec<(String, f64)> {
    let mut classes: Vec<(String, f64)> = Vec::new();
    for (label, hypothesis) in known {
        match classes.iter_mut().find(|(object, _)| *object == label.object) {
            Some((_, p)) => *p = (*p + hypothesis.score).min(1.0),
            None => classes.push((label.object.clone(), hypothesis.score.min(1.0))),
        }
    }
    classes
}

/// Place and variances in frame `base` of the object with that label.
fn placed(frame: &Frame, pose: &Pose, label: &Label, covariance: &[f64; 36]) -> Detection {
    let in_frame = of_quaternion(pose.orientation);
    let to_base = Rotation::from_rpy(frame.rpy);
    let offset = in_frame.turn(label.xyz);
    let center = std::array::from_fn(|axis| pose.position[axis] + offset[axis]);
    let turned = to_base.turn(center);
    let block = |first: usize| {
        let row = |i| std::array::from_fn(|j| covariance[6 * (first + i) + first + j]);
        variances(&to_base, &std::array::from_fn(row))
    };
    // Some drivers mark an unknown covariance by −1; NaN is just as unusable.
    let stated = |variance: f64| if variance.is_finite() { variance.max(0.0) } else { 0.0 };
    let ([x, y, z], [_, _, yaw]) = (block(0), block(3));
    Detection {
        xyz: std::array::from_fn(|axis| turned[axis] + frame.xyz[axis]),
        yaw: yaw_of(&followed(&followed(&Rotation::from_rpy(label.rpy), &in_frame), &to_base)),
        variances: [x, y, z, yaw].map(stated),
        ..Detection::default()
    }
}

impl Reported {
    /// Makes a message about a seen marker.
    pub fn marker(frame: &str, id: &str, pose: Pose, covariance: [f64; 36]) -> Self {
        let (id, track) = (id.to_owned(), id.to_owned());
        let hypotheses = vec![Hypothesis { id, score: 1.0, pose, covariance }];
        Self { frame: frame.to_owned(), track, hypotheses, center: None }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests")]
mod tests;
