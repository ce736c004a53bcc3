"""Topics of a group: readers and writers of typed messages in shared memory."""

from __future__ import annotations

import ctypes
import os
import sys
import time
from typing import Any, Iterator

import iceoryx2 as iox2

from . import messages as m
from ._fixed import InvalidMessage, Message, Topic
from ._postcard import decode, encode
from .group import Group

MESSAGE, JOINED_CLIENT, JOINED_SERVICE = range(3)
"""Events of a wake-up: a message was sent; a client, or a service, asks for the latest messages."""

BYTES = 4096
"""First guess at the size of an encoded message; it grows as needed."""


class WrongSchema(ConnectionError):
    """The group's programs and this package are not of one version."""


def log(text: str) -> None:
    """Writes a line to the service's log."""
    print(text, file=sys.stderr, flush=True)


class Bus:
    """A process's access to the topics of its group. It belongs to one thread."""

    def __init__(self, group: Group, name: str, *, epoch: int | None = None, incarnation: int = 0) -> None:
        """Joins the group as process `name`; `incarnation` is 0 for a client."""
        self.group, self.name, self.incarnation = group, name, incarnation
        shm = group.shm_name()
        self.epoch = group.epoch() if epoch is None else epoch
        iox2.set_log_level(iox2.LogLevel.Fatal)
        config = iox2.config.default()
        config.global_cfg.prefix = iox2.FileName.new(shm)
        config.global_cfg.root_path = iox2.Path.new(os.path.join("/dev/shm", shm))
        # The supervisor cleans up after processes that have died.
        config.global_cfg.node.cleanup_dead_nodes_on_creation = False
        config.global_cfg.node.cleanup_dead_nodes_on_destruction = False
        config.global_cfg.service.cleanup_dead_nodes_on_open = False
        builder = iox2.NodeBuilder.new().name(iox2.NodeName.new(name)).config(config)
        builder = builder.signal_handling_mode(iox2.SignalHandlingMode.Disabled)
        self.node = builder.create(iox2.ServiceType.Ipc)
        self._events: dict[str, Any] = {}
        self._notifiers: dict[str, Any] = {}

    def topic(self, name: str) -> Topic:
        """A topic by its name. Raises `KeyError` with the names that there are."""
        try:
            return m.TOPICS[name]
        except KeyError:
            raise KeyError(f"expected one of {', '.join(m.TOPICS)}; found {name}") from None

    def reader(self, topic: str) -> Reader:
        """A reader of a topic."""
        return Reader(self, self.topic(topic))

    def writer(self, topic: str) -> Writer:
        """A writer of a topic."""
        return Writer(self, self.topic(topic))

    def open(self, topic: Topic) -> Any:
        """Opens a topic, which the supervisor has made; refused if its messages are of another version."""
        message = topic.message
        verifier = iox2.AttributeVerifier.new().require(
            iox2.AttributeKey.new("schema"), iox2.AttributeValue.new(message.schema_key))
        is_fixed = issubclass(message, Message)
        builder = self.node.service_builder(iox2.ServiceName.new(topic.name))
        builder = builder.publish_subscribe(message if is_fixed else iox2.Slice[ctypes.c_uint8])
        try:
            return builder.user_header(m.Stamp).open_with_attributes(verifier)
        except iox2.PublishSubscribeOpenError as error:
            raise WrongSchema(
                f"topic {topic.name}: this package's {message.wire_name} has schema {message.schema_key}, the group's "
                f"topic does not open with it ({error}); help: install the package of the group's version, "
                "`pip install ./shared/sdk/python`") from None

    def event(self, service: str) -> Any:
        """The wake-up of a service."""
        if service not in self._events:
            name = iox2.ServiceName.new(f"wake/{service}")
            self._events[service] = self.node.service_builder(name).event().open()
        return self._events[service]

    def notify(self, service: str, event: int = MESSAGE) -> None:
        """Wakes a service. A failure is harmless: services look for messages from time to time, too."""
        try:
            if service not in self._notifiers:
                self._notifiers[service] = self.event(service).notifier_builder().create()
            self._notifiers[service].notify_with_custom_event_id(iox2.EventId.new(event))
        except (iox2.NotifierNotifyError, iox2.NotifierCreateError, iox2.EventOpenError):
            self._notifiers.pop(service, None)

    def greet(self, topic: Topic) -> None:
        """Asks the writer of a topic for its latest messages, for a reader that has just joined."""
        if topic.writer and topic.history and any(topic.writer in it.wakes for it in m.TOPICS.values()):
            self.notify(topic.writer, JOINED_SERVICE if self.incarnation else JOINED_CLIENT)


class Reader:
    """Reads a topic. Iterating over it takes the messages that have arrived and ends; it never waits."""

    def __init__(self, bus: Bus, topic: Topic) -> None:
        self.topic, self.bus = topic, bus
        self.rejected = 0
        """Messages that were rejected because they were invalid."""
        self._newest = 0
        self._is_fixed = issubclass(topic.message, Message)
        self._service = bus.open(topic)
        builder = self._service.subscriber_builder().buffer_size(topic.buffer)
        self._port = builder.history_request(topic.history).create()
        bus.greet(topic)

    def __iter__(self) -> Iterator[Any]:
        while (message := self.take()) is not None:
            yield message

    def latest(self) -> Any:
        """The newest message that has arrived since the last call; none if there is none."""
        newest = None
        for newest in self:
            pass
        return newest

    def take(self) -> Any:
        """The next message, or none. Those of other epochs and of earlier processes are left out, invalid ones
        are logged and left out."""
        while (sample := self._port.receive()) is not None:
            try:
                if not self._admits(sample.user_header().contents):
                    continue
                if self._is_fixed:
                    message = self.topic.message.from_buffer_copy(sample.payload().contents)
                    message.validate()
                    return message
                return decode(self.topic.message, bytes(sample.payload().as_memory_view()))
            except InvalidMessage as error:
                self.rejected += 1
                log(f"message rejected topic={self.topic.name} rejected={self.rejected}: {error}")
            finally:
                # A reader holds one message at a time.
                sample.delete()
        return None

    def _admits(self, stamp: m.Stamp) -> bool:
        """Whether a message counts: of this epoch, and of the writer's newest process that was started."""
        if stamp.epoch != self.bus.epoch:
            return False
        if self.topic.writer is None or stamp.incarnation == self._newest:
            return True
        if stamp.incarnation < self._newest:
            return False
        run = self.bus.group.run
        if not (run / f"n-{self.topic.writer}-{stamp.incarnation}").exists() and (run / "control.sock").exists():
            raise InvalidMessage(f"expected a running {self.topic.writer}, found one of start {stamp.incarnation}")
        self._newest = stamp.incarnation
        return True


class Writer:
    """Writes a topic. A message that finds no room makes the oldest one give way; nothing waits."""

    def __init__(self, bus: Bus, topic: Topic) -> None:
        self.topic, self.bus = topic, bus
        self._sequence = 0
        self._is_fixed = issubclass(topic.message, Message)
        self._is_state = topic.buffer == 1 and bool(topic.wakes)
        self._latest = b""
        self._service = bus.open(topic)
        builder = self._service.publisher_builder()
        builder = builder.backpressure_strategy(iox2.BackpressureStrategy.DiscardData)
        if not self._is_fixed:
            builder = builder.initial_max_slice_len(BYTES).allocation_strategy(iox2.AllocationStrategy.PowerOfTwo)
        try:
            self._port = builder.create()
        except iox2.PublisherCreateError as error:
            raise ConnectionError(
                f"topic {topic.name}: {error}; help: only {topic.writer or 'so many clients at a time'} may write it, "
                "see `whichone status`") from None

    def send(self, message: Any, *, wake: bool = True) -> None:
        """Sends a copy of a message under this process's stamp, and wakes its readers unless `wake` is false or the
        message repeats a state."""
        if not isinstance(message, self.topic.message):
            raise TypeError(f"topic {self.topic.name}: expected a {self.topic.message.__name__}, found {message!r}")
        if self._is_fixed:
            sample = self._port.loan_uninit()
            self._stamp(sample)
            sample.write_payload(message).send()
            data = bytes(message) if self._is_state else b""
        else:
            data = encode(message)
            sample = self._port.loan_slice_uninit(len(data))
            self._stamp(sample)
            ctypes.memmove(sample.payload_ptr, data, len(data))
            sample.assume_init().send()
        if wake and not (self._is_state and data == self._latest):
            self.wake()
        self._latest = data

    def wake(self) -> None:
        """Wakes the topic's readers."""
        for service in self.topic.wakes:
            self.bus.notify(service)

    def connect(self) -> None:
        """Connects readers that have joined since the last message, and so hands them the latest ones."""
        self._port.update_connections()

    def _stamp(self, sample: Any) -> None:
        # 0 would say that the writer does not count.
        self._sequence = self._sequence % 0xFFFFFFFF + 1
        stamp = sample.user_header().contents
        stamp.epoch, stamp.incarnation, stamp.sequence = self.bus.epoch, self.bus.incarnation, self._sequence
        stamp.sent_ns = time.monotonic_ns()
