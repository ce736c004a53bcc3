"""A camera with detectors: what Cyclone DDS publishes for the tests of objects."""

import time

from cyclone_types import (
    AlvarMarker,
    AlvarMarkers,
    BoundingBox3D,
    Detection3D,
    Detection3DArray,
    Header,
    ObjectHypothesis,
    ObjectHypothesisWithPose,
    Pose,
    PoseStamped,
    PoseWithCovariance,
    Quaternion,
    TFMessage,
    Time,
    TransformStamped,
    Vector3,
)
from cyclonedds.core import Policy, Qos
from cyclonedds.pub import DataWriter
from cyclonedds.topic import Topic
from cyclonedds.util import duration

PERIOD_S = 0.1
UNKNOWN = [0.0] * 36
# As drivers of cameras publish, and as transforms are published. The subscription to /tf is opened with the same.
BEST_EFFORT = Qos(Policy.Reliability.BestEffort, Policy.History.KeepLast(5))
RELIABLE = Qos(
    Policy.Reliability.Reliable(duration(seconds=1)),
    Policy.Durability.Volatile,
    Policy.History.KeepLast(100),
    Policy.TypeConsistency.AllowTypeCoercion(),
)
TOPICS = {
    "detections": ("rt/camera/detections", Detection3DArray, BEST_EFFORT),
    "ar_markers": ("rt/ar_pose_marker", AlvarMarkers, RELIABLE),
    "tf": ("rt/tf", TFMessage, RELIABLE),
}


def pose(x, y, z):
    return Pose(Vector3(x, y, z), Quaternion(0.0, 0.0, 0.0, 1.0))


def detections(header, seen):
    """[class, score, track, x, y, z] each; the place is that of the box."""
    return Detection3DArray(
        header,
        [
            Detection3D(
                header,
                [ObjectHypothesisWithPose(ObjectHypothesis(name, score), PoseWithCovariance(pose(0.0, 0.0, 0.0), UNKNOWN))],
                BoundingBox3D(pose(*place), Vector3(0.1, 0.1, 0.1)),
                track,
            )
            for name, score, track, *place in seen
        ],
    )


def ar_markers(header, seen):
    """[number, x, y, z] each; the outer header is empty."""
    empty = Header(Time(0, 0), "")
    return AlvarMarkers(empty, [AlvarMarker(header, n, 0, PoseStamped(empty, pose(*place))) for n, *place in seen])


def tf(header, seen):
    """[frame, x, y, z] each."""
    return TFMessage([TransformStamped(header, frame, pose(*place)) for frame, *place in seen])


MESSAGES = {"detections": detections, "ar_markers": ar_markers, "tf": tf}


class Camera:
    """Publishes ten times a second what it sees, in frame `lens`."""

    def __init__(self, participant):
        self.participant = participant
        self.writers = {}
        self.seen = {}
        self.age_s = 0.0
        self.due = 0.0

    def see(self, seen):
        """Takes what each detector sees from now on; `age_s` is the age of its images."""
        self.age_s = seen.pop("age_s", 0.0)
        self.seen.update(seen)
        for name in seen.keys() - self.writers.keys():
            topic, kind, qos = TOPICS[name]
            topic = Topic(self.participant, topic, kind, qos=qos)
            self.writers[name] = DataWriter(self.participant, topic, qos=qos)

    def publish(self):
        if time.monotonic() < self.due:
            return
        self.due = time.monotonic() + PERIOD_S
        ns = time.time_ns() - int(1e9 * self.age_s)
        header = Header(Time(ns // 1_000_000_000, ns % 1_000_000_000), "lens")
        for name, writer in self.writers.items():
            writer.write(MESSAGES[name](header, self.seen[name]))
