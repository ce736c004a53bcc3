#!/usr/bin/env python3
"""A viewer of the live view, written from the public protocol: https://github.com/foxglove/ws-protocol.

    live.py PLACE TOKEN dialogue OBJECT    reads all channels until OBJECT is delivered, and calls `say`
    live.py PLACE TOKEN refusals           tries to get in where it must not
    live.py PLACE TOKEN viewer SEED        has no right to speak, and sends malformed frames
    live.py PLACE TOKEN stall              sends requests and reads no answer until it is disconnected

Prints what it found as JSON. Anything unexpected ends the program.
"""

import json
import random
import socket
import struct
import sys
import time

import jsonschema
import websockets.exceptions
from mcap.records import Schema
from mcap_ros2.decoder import DecoderFactory
from websockets.sync.client import connect

SUBPROTOCOL = "foxglove.sdk.v1"
PATIENCE_S = 90.0


def open_view(place, token, role=None, origin=None, subprotocols=(SUBPROTOCOL,), **more):
    query = "&".join(f"{key}={value}" for key, value in (("token", token), ("role", role)) if value)
    origin = f"http://{place}" if origin is None else origin
    return connect(
        f"ws://{place}/foxglove?{query}",
        origin=origin or None,
        subprotocols=subprotocols or None,
        compression=None,
        max_size=16 << 20,
        proxy=None,
        **more,
    )


class View:
    """A connection, and what has arrived on it."""

    def __init__(self, socket):
        self.socket = socket
        self.info, self.channels, self.services = {}, {}, {}
        self.subscribed, self.counts, self.latest, self.decoders = {}, {}, {}, {}
        self.parameters, self.statuses, self.calls, self.seen = {}, [], {}, []
        self.until("the lists", lambda: self.info and self.channels and self.services)

    def until(self, what, is_so, patience_s=PATIENCE_S):
        end = time.monotonic() + patience_s
        while not is_so():
            left = end - time.monotonic()
            if left < 0:
                raise SystemExit(f"{what}: not within {patience_s} s; {self.counts} {self.statuses}")
            try:
                self.take(self.socket.recv(timeout=min(left, 1.0)))
            except TimeoutError:
                pass

    def take(self, frame):
        if isinstance(frame, bytes):
            return self.take_binary(frame)
        message = json.loads(frame)
        op = message["op"]
        if op == "serverInfo":
            self.info = message
        elif op == "advertise":
            self.channels.update({channel["id"]: channel for channel in message["channels"]})
        elif op == "advertiseServices":
            self.services.update({service["name"]: service for service in message["services"]})
        elif op == "parameterValues":
            values = {parameter["name"]: parameter["value"] for parameter in message["parameters"]}
            self.parameters[message.get("id")] = values
        elif op == "status":
            self.statuses.append(message)
        elif op == "serviceCallFailure":
            self.calls[message["callId"]] = {"failure": message["message"]}
        else:
            raise SystemExit(f"unknown message {frame}")

    def take_binary(self, frame):
        if frame[0] == 1:
            subscription, at_ns = struct.unpack_from("<IQ", frame, 1)
            channel = self.channels[self.subscribed[subscription]]
            topic = channel["topic"]
            self.counts[topic] = self.counts.get(topic, 0) + 1
            decoded = self.decode(channel, frame[13:])
            self.latest[topic] = (at_ns, decoded)
            self.seen.append(topic)
            if abs(time.time() - at_ns / 1e9) > 600:
                raise SystemExit(f"{topic}: {at_ns} is not a time of this test")
        elif frame[0] == 3:
            service, call, length = struct.unpack_from("<III", frame, 1)
            assert frame[13 : 13 + length] == b"json" and service == self.services["/say"]["id"]
            response = json.loads(frame[13 + length :])
            schema = json.loads(self.services["/say"]["response"]["schema"])
            jsonschema.validate(response, schema)
            self.calls[call] = response
        else:
            raise SystemExit(f"unknown operation code {frame[0]}")

    def decode(self, channel, data):
        """CDR by mcap-ros2-support, JSON against the schema of the channel."""
        number = channel["id"]
        if number not in self.decoders:
            name, encoding, text = channel["schemaName"], channel["schemaEncoding"], channel["schema"]
            if channel["encoding"] == "cdr":
                schema = Schema(id=number + 1, name=name, encoding=encoding, data=text.encode())
                self.decoders[number] = DecoderFactory().decoder_for("cdr", schema)
            else:
                schema = json.loads(text)
                jsonschema.Draft202012Validator.check_schema(schema)
                validator = jsonschema.Draft202012Validator(schema)

                def decode(data):
                    message = json.loads(data)
                    validator.validate(message)
                    return message

                self.decoders[number] = decode
        return self.decoders[number](data)

    def send(self, message):
        self.socket.send(json.dumps(message))

    def subscribe(self, topics=None):
        chosen = [c for c in self.channels.values() if topics is None or c["topic"] in topics]
        pairs = [(100 + channel["id"], channel["id"]) for channel in chosen]
        self.subscribed.update(pairs)
        pairs = [{"id": number, "channelId": channel} for number, channel in pairs]
        self.send({"op": "subscribe", "subscriptions": pairs})

    def get(self, number, names=()):
        self.send({"op": "getParameters", "parameterNames": list(names), "id": number})
        self.until("parameters", lambda: number in self.parameters)
        return self.parameters[number]

    def call(self, number, request, encoding=b"json", service=None):
        service = self.services["/say"]["id"] if service is None else service
        head = struct.pack("<BIII", 2, service, number, len(encoding))
        self.socket.send(head + encoding + json.dumps(request).encode())
        self.until("the answer to a call", lambda: number in self.calls)
        return self.calls[number]


def dialogue(place, token, wanted):
    with open_view(place, token, "operator") as socket:
        assert socket.subprotocol == SUBPROTOCOL
        view = View(socket)
        found = {"info": view.info, "parameters": view.get("one")}
        view.send({"op": "subscribeParameterUpdates", "parameterNames": ["/scene"]})
        view.until("subscribed parameters", lambda: None in view.parameters)
        found["subscribed"] = view.parameters[None]
        view.send({"op": "setParameters", "parameters": [{"name": "/scene", "value": "x"}], "id": "set"})
        view.until("unchanged parameters", lambda: "set" in view.parameters)
        found["set"] = [view.parameters["set"]["/scene"], len(view.statuses)]
        view.subscribe()
        # Nothing moves yet: what arrives of these is their state.
        states = ["/arm/status", "/arm/world", "/policy/view", "/robot_description", "/joint_states", "/scene", "/tf"]
        view.until("states", lambda: all(topic in view.latest for topic in states), 20)
        found["says"] = [
            view.call(1, {"text": "get me the bowl", "key": "first"}),
            view.call(2, {"text": "get me the bowl", "key": "first"}),
            view.call(3, {"text": "get me the bowl", "wrong": 1}),
            view.call(4, {"text": "x"}, encoding=b"cdr"),
            view.call(5, {"text": "x"}, service=77),
            view.call(6, {"text": "get me the cup", "key": "first"}),
        ]
        # The test answers the robot's questions.
        print("said", file=sys.stderr, flush=True)
        last = lambda: (view.latest["/policy/view"][1]["last"] or {}).get("name")
        view.until("the delivery", lambda: last() == wanted)
        found["said"] = view.latest["/dialogue"][1]["message"]
        # A state stands until the next one: it is sent again to one who subscribes again.
        view.send({"op": "unsubscribe", "subscriptionIds": list(view.subscribed)})
        view.get("two")
        counts = dict(view.counts)
        view.seen.clear()
        view.subscribe(states)
        view.until("states again", lambda: all(topic in view.seen for topic in states), 20)
        with open_view(place, token) as second:
            late = View(second)
            late.subscribe(states)
            late.until("states of a second viewer", lambda: all(topic in late.latest for topic in states), 20)
        found["counts"] = counts
    # The key outlives the connection.
    with open_view(place, token, "operator") as socket:
        view = View(socket)
        end = time.monotonic() + PATIENCE_S
        for number in range(10, 10_000):
            again = view.call(number, {"text": "get me the bowl", "key": "first"})
            # Control of the robot outlives a lost connection by 15 s.
            if "failure" not in again or time.monotonic() > end:
                break
            time.sleep(1.0)
        found["again"] = again
    return found


def refusals(place, token):
    def status(**how):
        try:
            with open_view(place, **how):
                return 101
        except websockets.exceptions.InvalidStatus as refused:
            return refused.response.status_code

    return {
        "own": status(token=token),
        "allowed": status(token=token, origin="https://viewer.example"),
        "foreign": status(token=token, origin="https://evil.example"),
        "null": status(token=token, origin="null"),
        "no_origin": status(token=token, origin=""),
        "no_token": status(token=None),
        "wrong_token": status(token="wrong-token-0123"),
        "older_protocol": status(token=token, subprotocols=("foxglove.websocket.v1",)),
        "no_protocol": status(token=token, subprotocols=()),
        "screen": status(token=token, role="screen"),
        "bearer": status(token=None, additional_headers={"Authorization": f"Bearer {token}"}),
    }


def malformed(chance, view):
    """A frame that is almost one of the protocol's."""
    valid = [
        json.dumps({"op": "subscribe", "subscriptions": [{"id": 7, "channelId": 3}]}).encode(),
        json.dumps({"op": "unsubscribe", "subscriptionIds": [7]}).encode(),
        json.dumps({"op": "getParameters", "parameterNames": ["/scene"], "id": "x"}).encode(),
        json.dumps({"op": "subscribe", "subscriptions": [{"id": 2**31, "channelId": 2**53}]}).encode(),
        json.dumps({"op": "advertise", "channels": []}).encode(),
        json.dumps({"op": "fetchAsset", "uri": "file:///etc/passwd", "requestId": 1}).encode(),
        struct.pack("<BIII", 2, 1, 9, 4) + b'json{"text":"get me the bowl"}',
        struct.pack("<BIII", 2, 1, 9, 2**32 - 1),
        struct.pack("<BI", 1, 3) + b"client data",
        b"",
    ]
    frame = bytearray(chance.choice(valid))
    for _ in range(chance.randrange(4)):
        at = chance.randrange(len(frame) + 1)
        what = chance.randrange(3)
        if what == 0:
            frame.insert(at, chance.randrange(256))
        elif what == 1:
            del frame[at : at + chance.randrange(1, 9)]
        elif at < len(frame):
            frame[at] ^= 1 << chance.randrange(8)
    is_text = chance.random() < 0.5
    return bytes(frame).decode(errors="replace") if is_text else bytes(frame)


def viewer(place, token, seed):
    chance = random.Random(seed)
    print(f"seed {seed}", file=sys.stderr, flush=True)
    with open_view(place, token) as socket:
        view = View(socket)
        found = {"says": [view.call(1, {"text": "get me the bowl", "key": "viewer"})]}
        # Whichever channel a frame happens to subscribe to under whichever number.
        view.take_binary = lambda frame: None if frame[0] == 1 else View.take_binary(view, frame)
        for _ in range(1_000):
            view.socket.send(malformed(chance, view))
        found["parameters"] = view.get("after")
        found["statuses"] = len(view.statuses)
        found["levels"] = sorted({status["level"] for status in view.statuses})
        try:
            view.call(2, {"text": "x" * 1_000_000})
        except websockets.exceptions.ConnectionClosed as closed:
            found["too_long"] = [closed.rcvd.code, closed.rcvd.reason]
    return found


def stall(place, token):
    host, port = place.rsplit(":", 1)
    # Small buffers, which are soon full.
    raw = socket.socket()
    raw.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    raw.connect((host, int(port)))
    how = {"sock": raw, "max_queue": 1, "ping_interval": None, "close_timeout": 1}
    with open_view(place, token, **how) as view:
        request = json.dumps({"op": "getParameters", "parameterNames": [], "id": "x"})
        try:
            # Far more than all buffers on the way hold.
            for _ in range(1_000):
                view.send(request)
        except websockets.exceptions.ConnectionClosed:
            pass
        # Its end is seen by the test in the console's metrics; until then nothing is read.
        sys.stdin.read()
    return {}


def main():
    place, token, scenario, *more = sys.argv[1:]
    scenarios = {"dialogue": dialogue, "refusals": refusals, "viewer": viewer, "stall": stall}
    json.dump(scenarios[scenario](place, token, *more), sys.stdout)


main()
