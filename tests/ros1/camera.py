"""A camera with detectors in rospy, for tests of the bridge. Its clock is an hour ahead.

Ten times a second it publishes what the latest line on standard input says that it sees, an object of JSON with
the keys `detections` ([class, score, x, y, z] each), `apriltags` ([[number, …], x, y, z]) and `ar_markers`
([number, x, y, z]), all in frame `lens`. Keys that are left out keep what they had. Each line is answered with the
number of subscribers.
"""

import json
import sys
import threading
import time

import rospy
from apriltag_ros.msg import AprilTagDetection, AprilTagDetectionArray
from ar_track_alvar_msgs.msg import AlvarMarker, AlvarMarkers
from geometry_msgs.msg import Point, Pose, PoseStamped, PoseWithCovariance, PoseWithCovarianceStamped, Quaternion
from sensor_msgs.msg import PointCloud2
from std_msgs.msg import Header
from vision_msgs.msg import BoundingBox3D, Detection3D, Detection3DArray, ObjectHypothesisWithPose

CLOCK_AHEAD_S = 3600.0
PERIOD_S = 0.1
UNKNOWN = [0.0] * 36
# As large as that of a small depth camera: it must not delay the rest.
CLOUD = PointCloud2(height=240, width=320, point_step=16, row_step=320 * 16, data=bytes(240 * 320 * 16))


def pose(x, y, z):
    return Pose(Point(x, y, z), Quaternion(0, 0, 0, 1))


def detections(header, seen):
    array = Detection3DArray(header=header)
    for number, score, *place in seen:
        own = PoseWithCovariance(pose(*place), UNKNOWN)
        result = ObjectHypothesisWithPose(id=number, score=score, pose=own)
        array.detections.append(Detection3D(header, [result], BoundingBox3D(), CLOUD))
    return array


def apriltags(header, seen):
    array = AprilTagDetectionArray(header=header)
    for numbers, *place in seen:
        own = PoseWithCovarianceStamped(header, PoseWithCovariance(pose(*place), UNKNOWN))
        array.detections.append(AprilTagDetection(numbers, [0.05] * len(numbers), own))
    return array


def ar_markers(header, seen):
    # As its own program does, with an empty header outside.
    array = AlvarMarkers()
    for number, *place in seen:
        array.markers.append(AlvarMarker(header, number, 0, PoseStamped(Header(), pose(*place))))
    return array


DETECTORS = {
    "detections": ("/detections", Detection3DArray, detections),
    "apriltags": ("/tag_detections", AprilTagDetectionArray, apriltags),
    "ar_markers": ("/ar_pose_marker", AlvarMarkers, ar_markers),
}


def main():
    rospy.init_node("camera", disable_signals=True)
    seen = {name: [] for name in DETECTORS}
    publishers = {
        name: rospy.Publisher(topic, kind, queue_size=10) for name, (topic, kind, _) in DETECTORS.items()
    }

    def publish():
        while not rospy.is_shutdown():
            header = Header(stamp=rospy.Time.from_sec(time.time() + CLOCK_AHEAD_S), frame_id="lens")
            for name, (_, _, message) in DETECTORS.items():
                publishers[name].publish(message(header, seen[name]))
            time.sleep(PERIOD_S)

    threading.Thread(target=publish, daemon=True).start()
    for line in sys.stdin:
        seen.update(json.loads(line))
        connected = sum(publisher.get_num_connections() for publisher in publishers.values())
        print(json.dumps({"subscribers": connected}), flush=True)


if __name__ == "__main__":
    main()
