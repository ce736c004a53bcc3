"""The contract of a service, in Python: messages, topics, and the bond with the supervisor.

The messages are built from `tests/golden/wire_layout.txt`, field by field, so they are those of the
build whose file it is; a group of another build refuses them when a topic is opened.
"""

import ctypes
import os
import re
import select
import signal
import socket
import time

import iceoryx2 as iox2

INTEGERS = {"u8": ctypes.c_uint8, "u16": ctypes.c_uint16, "u32": ctypes.c_uint32,
            "u64": ctypes.c_uint64, "i32": ctypes.c_int32, "f32": ctypes.c_float,
            "f64": ctypes.c_double}
BEAT_S = 0.2


def fnv1a(data, value=0xCBF29CE484222325):
    """64-bit FNV-1a."""
    for byte in data:
        value = ((value ^ byte) * 0x100000001B3) & 0xFFFFFFFFFFFFFFFF
    return value


def text_of(fixed):
    """The text of a `FixedText`."""
    return bytes(fixed.bytes[:fixed.len]).decode(errors="replace")


def put_text(fixed, text):
    """Writes a text into a `FixedText`, without what does not fit."""
    data = text.encode()[:len(fixed.bytes)].decode(errors="ignore").encode()
    fixed.len, fixed.bytes[:len(data)] = len(data), data


class Layout:
    """The wire layout's structs by name, and the schema key of each."""

    def __init__(self, path):
        self.structs, self.keys = {}, {}
        name, size, fields = None, 0, []
        for line in open(path, encoding="utf-8").read().splitlines() + [""]:
            head = re.fullmatch(r"(\w+) size (\d+) schema ([0-9a-f]{16})", line)
            field = re.fullmatch(r" +(\d+) \+(\d+) +(\w+): (.+)", line)
            if head:
                name, size, fields = head[1], int(head[2]), []
                self.keys[name] = head[3]
            elif field:
                fields.append((field[3], int(field[1]), int(field[2]), field[4]))
            elif name and size:
                self.structs[name] = self._struct(name, size, fields)
                name = None
            else:
                name = None

    def _struct(self, name, size, fields):
        members = [(field, self._type(kind, length)) for field, _, length, kind in fields]
        body = {"_fields_": members, "type_name": staticmethod(lambda: name)}
        struct = type(name, (ctypes.Structure,), body)
        for field, offset, length, _ in fields:
            found = getattr(struct, field)
            if (found.offset, found.size) != (offset, length):
                raise SystemExit(f"{name}.{field} is not where the layout has it")
        if ctypes.sizeof(struct) != size:
            raise SystemExit(f"{name} is not as long as the layout has it")
        return struct

    def _type(self, kind, length):
        array = re.fullmatch(r"\[+([\w<>]+);.*\]", kind)
        if array:
            text = re.fullmatch(r"FixedText<(\d+)>", array[1])
            element = self._type(array[1], 4 + int(text[1]) if text else 0)
            return element * (length // ctypes.sizeof(element))
        if kind.startswith("Code<"):
            return ctypes.c_uint8
        if kind.startswith("FixedText"):
            text = {"_fields_": [("len", ctypes.c_uint32), ("bytes", ctypes.c_uint8 * (length - 4))]}
            return type("FixedText", (ctypes.Structure,), text)
        # The structs' own names on the wire leave the prefix out.
        known = INTEGERS.get(kind) or self.structs.get(kind.removeprefix("Wire"))
        # Types that no service here reads, such as sound, stay bytes.
        return known or ctypes.c_uint8 * length


class Bus:
    """This process's access to the topics of its group."""

    def __init__(self, layout, service):
        self.layout = layout
        self.epoch = int(os.environ["WHICHONE_EPOCH"])
        self.incarnation = int(os.environ["WHICHONE_INCARNATION"])
        self.root = os.path.join(os.path.abspath(os.environ["WHICHONE_HOME"]),
                                 os.environ["WHICHONE_GROUP"])
        iox2.set_log_level(iox2.LogLevel.Fatal)
        config = iox2.config.default()
        with open(os.path.join(self.root, "run", "shm"), encoding="ascii") as file:
            name = file.read()
        config.global_cfg.prefix = iox2.FileName.new(name)
        config.global_cfg.root_path = iox2.Path.new(os.path.join("/dev/shm", name))
        # The supervisor cleans up after dead processes.
        config.global_cfg.node.cleanup_dead_nodes_on_creation = False
        config.global_cfg.node.cleanup_dead_nodes_on_destruction = False
        config.global_cfg.service.cleanup_dead_nodes_on_open = False
        builder = iox2.NodeBuilder.new().name(iox2.NodeName.new(service)).config(config)
        builder = builder.signal_handling_mode(iox2.SignalHandlingMode.Disabled)
        self.node = builder.create(iox2.ServiceType.Ipc)
        self.newest = {}

    def topic(self, name, message):
        """Opens a topic that the supervisor has made; rejected if the schema differs."""
        key = iox2.AttributeKey.new("schema")
        value = iox2.AttributeValue.new(self.layout.keys[message])
        verifier = iox2.AttributeVerifier.new().require(key, value)
        builder = self.node.service_builder(iox2.ServiceName.new(name))
        builder = builder.publish_subscribe(self.layout.structs[message])
        builder = builder.user_header(self.layout.structs["Stamp"])
        return builder.open_with_attributes(verifier)

    def event(self, service):
        """The wake-up of a service."""
        name = iox2.ServiceName.new(f"wake/{service}")
        return self.node.service_builder(name).event().open()

    def receive(self, subscriber):
        """Yields the waiting messages, without those of other epochs and earlier incarnations."""
        while (sample := subscriber.receive()) is not None:
            stamp = sample.user_header().contents
            epoch, incarnation = stamp.epoch, stamp.incarnation
            message = sample.payload().contents
            message = type(message).from_buffer_copy(message)
            # A reader may hold one message at a time, so this one is given back before the next.
            sample.delete()
            if epoch == self.epoch and incarnation >= self.newest.get(id(subscriber), 0):
                self.newest[id(subscriber)] = incarnation
                yield message

    def send(self, publisher, message):
        """Sends a copy of the message under this process's stamp."""
        sample = publisher.loan_uninit()
        stamp = sample.user_header().contents
        stamp.epoch, stamp.incarnation, stamp.sequence = self.epoch, self.incarnation, 0
        stamp.sent_ns = time.monotonic_ns()
        sample.write_payload(message).send()


class Bond:
    """The connection to the supervisor: readiness and beats out, shutdown requests in."""

    def __init__(self):
        self.is_stopping = False
        signal.signal(signal.SIGTERM, self._stop)
        signal.signal(signal.SIGINT, self._stop)
        self.lifeline = int(os.environ["WHICHONE_LIFELINE_FD"])
        self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self.socket.setblocking(False)
        self.beaten = 0.0

    def _stop(self, *_):
        self.is_stopping = True

    def say(self, text):
        """Sends a datagram; one that finds no room is dropped. Returns whether it was sent."""
        try:
            self.socket.sendto(text.encode(), os.environ["NOTIFY_SOCKET"])
        except OSError:
            return False
        return True

    def beat(self):
        """Sends a beat if one is due: called once in each pass of the main loop."""
        if time.monotonic() - self.beaten >= BEAT_S:
            self.beaten = time.monotonic()
            self.say("WATCHDOG=1\nX_INPUT_AGE_MS=0\n")

    def ends(self):
        """Returns whether to shut down: on request, or because the supervisor is gone."""
        return self.is_stopping or bool(select.select([self.lifeline], [], [], 0)[0])
