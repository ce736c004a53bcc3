"""A ROS 2 program as Cyclone DDS sees it, for tests of the node: the layout of ROS 2 over plain DDS.

One command a line on standard input, each answered with one line of JSON; see peer.py.
"""

import os
import struct
import time

# Loopback only, found by unicast: set before the library reads it.
os.environ.setdefault(
    "CYCLONEDDS_URI",
    """<CycloneDDS><Domain Id="any">
    <General><Interfaces><NetworkInterface name="lo"/></Interfaces><AllowMulticast>false</AllowMulticast></General>
    <Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>20</MaxAutoParticipantIndex>
    <Peers><Peer Address="127.0.0.1"/></Peers></Discovery></Domain></CycloneDDS>""",
)

import peer
from cyclone_camera import Camera
from cyclone_types import (
    DiagnosticArray,
    Empty,
    JointState,
    MarkerArray,
    String,
    TFMessage,
    TriggerRequest,
    TriggerResponse,
)
from cyclonedds.core import Policy, Qos
from cyclonedds.domain import DomainParticipant
from cyclonedds.pub import DataWriter
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from cyclonedds.util import duration

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


def taken(reader, most):
    """Samples without those that only tell that a writer has ended."""
    samples = reader.take(N=most)
    return [it for it in samples if not getattr(it, "sample_info", None) or it.sample_info.valid_data]


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
        self.camera = Camera(self.participant)

    def poll(self, seen):
        for name, reader in self.readers.items():
            for sample in taken(reader, 200):
                seen(name, sample)
        self.camera.publish()
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
            for reply in taken(reader, 10):
                if (reply.guid, reply.seq) == (guid, self.number):
                    return {"success": reply.success, "message": reply.message}
        return None


if __name__ == "__main__":
    peer.run(Peer)
