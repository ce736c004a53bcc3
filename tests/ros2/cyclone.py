"""A ROS 2 program as Cyclone DDS sees it, for tests of the node: the layout of ROS 2 over plain DDS.

One command a line on standard input, each answered with one line of JSON; see peer.py.
"""

import os
import struct
import time
from dataclasses import dataclass

# Loopback only, found by unicast: set before the library reads it.
os.environ.setdefault(
    "CYCLONEDDS_URI",
    """<CycloneDDS><Domain Id="any">
    <General><Interfaces><NetworkInterface name="lo"/></Interfaces><AllowMulticast>false</AllowMulticast></General>
    <Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>20</MaxAutoParticipantIndex>
    <Peers><Peer Address="127.0.0.1"/></Peers></Discovery></Domain></CycloneDDS>""",
)

import peer
from cyclonedds.core import Policy, Qos
from cyclonedds.domain import DomainParticipant
from cyclonedds.idl import IdlStruct
from cyclonedds.idl.annotations import final
from cyclonedds.idl.types import float32, float64, int32, int64, sequence, uint8, uint32, uint64
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration




@dataclass
@final
class Time(IdlStruct, typename="builtin_interfaces::msg::dds_::Time_"):
    sec: int32
    nanosec: uint32


@dataclass
@final
class Header(IdlStruct, typename="std_msgs::msg::dds_::Header_"):
    stamp: Time
    frame_id: str


@dataclass
@final
class String(IdlStruct, typename="std_msgs::msg::dds_::String_"):
    data: str


@dataclass
@final
class Empty(IdlStruct, typename="std_msgs::msg::dds_::Empty_"):
    structure_needs_at_least_one_member: uint8


@dataclass
@final
class JointState(IdlStruct, typename="sensor_msgs::msg::dds_::JointState_"):
    header: Header
    name: sequence[str]
    position: sequence[float64]
    velocity: sequence[float64]
    effort: sequence[float64]


@dataclass
@final
class Vector3(IdlStruct, typename="geometry_msgs::msg::dds_::Vector3_"):
    x: float64
    y: float64
    z: float64


@dataclass
@final
class Quaternion(IdlStruct, typename="geometry_msgs::msg::dds_::Quaternion_"):
    x: float64
    y: float64
    z: float64
    w: float64


@dataclass
@final
class Pose(IdlStruct, typename="geometry_msgs::msg::dds_::Pose_"):
    position: Vector3
    orientation: Quaternion


@dataclass
@final
class TransformStamped(IdlStruct, typename="geometry_msgs::msg::dds_::TransformStamped_"):
    header: Header
    child_frame_id: str
    transform: Pose


@dataclass
@final
class TFMessage(IdlStruct, typename="tf2_msgs::msg::dds_::TFMessage_"):
    transforms: sequence[TransformStamped]


@dataclass
@final
class ColorRGBA(IdlStruct, typename="std_msgs::msg::dds_::ColorRGBA_"):
    r: float32
    g: float32
    b: float32
    a: float32


@dataclass
@final
class CompressedImage(IdlStruct, typename="sensor_msgs::msg::dds_::CompressedImage_"):
    header: Header
    format: str
    data: sequence[uint8]


@dataclass
@final
class UVCoordinate(IdlStruct, typename="visualization_msgs::msg::dds_::UVCoordinate_"):
    u: float32
    v: float32


@dataclass
@final
class MeshFile(IdlStruct, typename="visualization_msgs::msg::dds_::MeshFile_"):
    filename: str
    data: sequence[uint8]


@dataclass
@final
class Marker(IdlStruct, typename="visualization_msgs::msg::dds_::Marker_"):
    header: Header
    ns: str
    id: int32
    type: int32
    action: int32
    pose: Pose
    scale: Vector3
    color: ColorRGBA
    lifetime: Time
    frame_locked: bool
    points: sequence[Vector3]
    colors: sequence[ColorRGBA]
    texture_resource: str
    texture: CompressedImage
    uv_coordinates: sequence[UVCoordinate]
    text: str
    mesh_resource: str
    mesh_file: MeshFile
    mesh_use_embedded_materials: bool


@dataclass
@final
class MarkerArray(IdlStruct, typename="visualization_msgs::msg::dds_::MarkerArray_"):
    markers: sequence[Marker]


@dataclass
@final
class KeyValue(IdlStruct, typename="diagnostic_msgs::msg::dds_::KeyValue_"):
    key: str
    value: str


@dataclass
@final
class DiagnosticStatus(IdlStruct, typename="diagnostic_msgs::msg::dds_::DiagnosticStatus_"):
    level: uint8
    name: str
    message: str
    hardware_id: str
    values: sequence[KeyValue]


@dataclass
@final
class DiagnosticArray(IdlStruct, typename="diagnostic_msgs::msg::dds_::DiagnosticArray_"):
    header: Header
    status: sequence[DiagnosticStatus]


@dataclass
@final
class TriggerRequest(IdlStruct, typename="std_srvs::srv::dds_::Trigger_Request_"):
    guid: uint64
    seq: int64
    structure_needs_at_least_one_member: uint8


@dataclass
@final
class TriggerResponse(IdlStruct, typename="std_srvs::srv::dds_::Trigger_Response_"):
    guid: uint64
    seq: int64
    success: bool
    message: str


TYPES = {
    "String": String,
    "JointState": JointState,
    "MarkerArray": MarkerArray,
    "TFMessage": TFMessage,
    "DiagnosticArray": DiagnosticArray,
}


def qos(latched, depth):
    durability = Policy.Durability.TransientLocal if latched else Policy.Durability.Volatile
    return Qos(
        Policy.Reliability.Reliable(duration(seconds=1)),
        durability,
        Policy.History.KeepLast(depth),
        # Of ROS's types, only names count.
        Policy.TypeConsistency.AllowTypeCoercion(),
    )


class Peer:
    def __init__(self, domain):
        self.participant = DomainParticipant(domain)
        self.readers = {}
        for name, (kind, latched, depth) in peer.SUBSCRIBED.items():
            topic = Topic(self.participant, f"rt{name}", TYPES[kind], qos=qos(latched, depth))
            self.readers[name] = DataReader(self.participant, topic, qos=qos(latched, depth))
        hear = Topic(self.participant, "rt/whichone/hear", String, qos=qos(False, 10))
        self.hear = DataWriter(self.participant, hear, qos=qos(False, 10))
        stop = Topic(self.participant, "rt/whichone/stop", Empty, qos=qos(False, 10))
        self.stop = DataWriter(self.participant, stop, qos=qos(False, 10))
        self.calls = {}
        for name in ["stop", "resume", "cancel"]:
            request = Topic(self.participant, f"rq/whichone/{name}Request", TriggerRequest, qos=qos(False, 10))
            reply = Topic(self.participant, f"rr/whichone/{name}Reply", TriggerResponse, qos=qos(False, 10))
            self.calls[name] = (
                DataWriter(self.participant, request, qos=qos(False, 10)),
                DataReader(self.participant, reply, qos=qos(False, 10)),
            )
        self.number = 0

    def poll(self, seen):
        for name, reader in self.readers.items():
            for sample in reader.take(N=200):
                if getattr(sample, "sample_info", None) and not sample.sample_info.valid_data:
                    continue
                seen(name, sample)
        time.sleep(0.002)

    def matched(self):
        writers = [self.hear, self.stop] + [writer for writer, _ in self.calls.values()]
        return all(writer.get_matched_subscriptions() for writer in writers)

    def say(self, text):
        self.hear.write(String(text))

    def stop_topic(self):
        self.stop.write(Empty(0))

    def call(self, name, timeout, poll):
        self.number += 1
        writer, reader = self.calls[name]
        guid = struct.unpack("<Q", struct.pack("<II", os.getpid(), self.number))[0]
        writer.write(TriggerRequest(guid, self.number, 0))
        until = time.monotonic() + timeout
        while time.monotonic() < until:
            poll()
            for reply in reader.take(N=10):
                if (reply.guid, reply.seq) == (guid, self.number):
                    return {"success": reply.success, "message": reply.message}
        return None


if __name__ == "__main__":
    peer.run(Peer)
