"""The part of the test programs that is the same for every implementation of ROS 2.

Commands, one a line on standard input, each answered with one line of JSON:
    look                what has been seen of each topic
    say TEXT            publishes words
    flood N             publishes words N times, as fast as possible
    stop                publishes an Empty
    call NAME           calls a service
    forget              forgets what has been seen
    see JSON            lets detectors see objects, with Cyclone DDS alone
"""

import json
import queue
import sys
import threading
import time

# Type, latched, depth.
SUBSCRIBED = {
    "/joint_states": ("JointState", False, 50),
    "/robot_description": ("String", True, 1),
    "/tf": ("TFMessage", False, 100),
    "/diagnostics": ("DiagnosticArray", False, 10),
    "/whichone/say": ("String", False, 20),
    "/whichone/heard": ("String", False, 20),
    "/whichone/objects": ("MarkerArray", True, 1),
    "/whichone/state": ("String", True, 1),
}
CALL_TIMEOUT_S = 10.0


class Seen:
    def __init__(self):
        self.forget()

    def forget(self):
        self.count = {name: 0 for name in SUBSCRIBED}
        self.latest = {}
        self.texts = {"/whichone/say": [], "/whichone/heard": []}
        self.delays_ms = []

    def add(self, name, message):
        self.count[name] += 1
        self.latest[name] = message
        if name in self.texts:
            self.texts[name].append(message.data)
        if name == "/joint_states":
            stamp = message.header.stamp
            self.delays_ms.append(1e3 * (time.time() - stamp.sec - 1e-9 * stamp.nanosec))

    def report(self):
        report = {"count": self.count, "texts": self.texts}
        latest = self.latest
        if joints := latest.get("/joint_states"):
            report["joints"] = dict(zip(list(joints.name), list(joints.position)))
            delays = sorted(self.delays_ms)
            at = lambda share: delays[min(int(share * len(delays)), len(delays) - 1)]
            report["delay_ms"] = {"p50": at(0.5), "p99": at(0.99), "max": delays[-1]}
        if text := latest.get("/robot_description"):
            report["description"] = text.data
        if text := latest.get("/whichone/state"):
            report["state"] = json.loads(text.data)
        if array := latest.get("/whichone/objects"):
            report["markers"] = [
                {"ns": m.ns, "id": m.id, "text": m.text, "color": [m.color.r, m.color.g, m.color.b, m.color.a]}
                for m in array.markers
            ]
        if tf := latest.get("/tf"):
            report["frames"] = [[t.header.frame_id, t.child_frame_id] for t in tf.transforms]
        if array := latest.get("/diagnostics"):
            level = lambda value: value[0] if isinstance(value, bytes) else value
            report["diagnostics"] = {
                s.name: {"level": level(s.level), "message": s.message, "values": {v.key: v.value for v in s.values}}
                for s in array.status
            }
        return report


def run(make):
    """Runs a peer in the domain that the first argument names."""
    peer, seen = make(int(sys.argv[1])), Seen()
    lines = queue.Queue()

    def read():
        for line in sys.stdin:
            lines.put(line.rstrip("\n"))
        lines.put(None)

    threading.Thread(target=read, daemon=True).start()
    poll = lambda: peer.poll(seen.add)
    while True:
        poll()
        try:
            line = lines.get_nowait()
        except queue.Empty:
            continue
        if line is None:
            return
        word, _, rest = line.partition(" ")
        answer = {}
        if word == "look":
            answer = seen.report() | {"matched": peer.matched(), "untyped": getattr(peer, "untyped", [])}
        elif word == "say":
            peer.say(rest)
        elif word == "flood":
            began = time.monotonic()
            for number in range(int(rest)):
                peer.say(f"the bowl {number}")
            answer = {"seconds": time.monotonic() - began}
        elif word == "stop":
            peer.stop_topic()
        elif word == "call":
            began = time.monotonic()
            answer = peer.call(rest, CALL_TIMEOUT_S, poll) or {"success": None, "message": "no response"}
            answer["ms"] = 1e3 * (time.monotonic() - began)
        elif word == "see":
            peer.camera.see(json.loads(rest))
        elif word == "forget":
            seen.forget()
        else:
            answer = {"error": f"unknown command {word}"}
        print(json.dumps(answer), flush=True)
