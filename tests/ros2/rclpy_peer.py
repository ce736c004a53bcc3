"""A ROS 2 program in rclpy, for tests of the node. See peer.py for its commands.

rclpy from PyPI lacks visualization_msgs or tf2_msgs in some sets: topics whose type is missing are left out, and
named in the answer to `look` as `untyped`.
"""

import importlib
import os
import time

os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"

import sys

os.environ["ROS_DOMAIN_ID"] = sys.argv[1]

import peer
import rclpy
from rclpy.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy
from std_msgs.msg import Empty, String
from std_srvs.srv import Trigger

PACKAGES = {
    "String": "std_msgs",
    "JointState": "sensor_msgs",
    "MarkerArray": "visualization_msgs",
    "TFMessage": "tf2_msgs",
    "DiagnosticArray": "diagnostic_msgs",
}


def qos(latched, depth):
    durability = DurabilityPolicy.TRANSIENT_LOCAL if latched else DurabilityPolicy.VOLATILE
    return QoSProfile(
        reliability=ReliabilityPolicy.RELIABLE, durability=durability, history=HistoryPolicy.KEEP_LAST, depth=depth
    )


class Peer:
    def __init__(self, _domain):
        rclpy.init()
        self.node = rclpy.create_node("peer")
        self.arrived, self.untyped, self.subscriptions = [], [], []
        for name, (kind, latched, depth) in peer.SUBSCRIBED.items():
            try:
                message = getattr(importlib.import_module(f"{PACKAGES[kind]}.msg"), kind)
            except ImportError:
                self.untyped.append(name)
                continue
            keep = lambda message, name=name: self.arrived.append((name, message))
            self.subscriptions.append(self.node.create_subscription(message, name, keep, qos(latched, depth)))
        self.hear = self.node.create_publisher(String, "/whichone/hear", qos(False, 10))
        self.stop = self.node.create_publisher(Empty, "/whichone/stop", qos(False, 10))
        self.clients = {
            name: self.node.create_client(Trigger, f"/whichone/{name}") for name in ["stop", "resume", "cancel"]
        }

    def poll(self, seen):
        rclpy.spin_once(self.node, timeout_sec=0.002)
        for name, message in self.arrived:
            seen(name, message)
        self.arrived.clear()

    def matched(self):
        topics = all(publisher.get_subscription_count() for publisher in [self.hear, self.stop])
        return topics and all(client.service_is_ready() for client in self.clients.values())

    def say(self, text):
        self.hear.publish(String(data=text))

    def stop_topic(self):
        self.stop.publish(Empty())

    def call(self, name, timeout, poll):
        future = self.clients[name].call_async(Trigger.Request())
        until = time.monotonic() + timeout
        while time.monotonic() < until and not future.done():
            poll()
        if not future.done():
            return None
        return {"success": future.result().success, "message": future.result().message}


if __name__ == "__main__":
    peer.run(Peer)
