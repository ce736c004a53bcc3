"""A service under a supervisor: readiness, beats, wake-ups, and its end."""

from __future__ import annotations

import fcntl
import os
import select
import signal
import socket
import sys
import threading
import time
from typing import Any, ClassVar

import iceoryx2 as iox2

from .bus import JOINED_SERVICE, Bus, Reader, Writer, WrongSchema, log
from .group import Group

USAGE, STORAGE, CONFIG = 64, 74, 78
"""Exit codes: the start was wrong (not tried again), something is short, the configuration is wrong."""

ORPHAN_GRACE_S = 15.0
"""Time for a service's end after its supervisor has died."""


def environment(key: str) -> str:
    """A variable that the supervisor sets. Exits with 64 where the program was started by hand."""
    value = os.environ.get(key)
    if not value:
        print(f"{key} is not set; help: services are started by their supervisor, e.g. "
              f"`whichone swap grounding -- python3 {sys.argv[0]}`", file=sys.stderr)
        raise SystemExit(USAGE)
    return value


class Supervised:
    """The connection to the supervisor: readiness and beats out, the request to end in."""

    def __init__(self, group: Group) -> None:
        self._is_stopping = False
        for number in (signal.SIGTERM, signal.SIGINT):
            signal.signal(number, self._stop)
        self._lifeline = int(os.environ.get("WHICHONE_LIFELINE_FD") or -1)
        self._address = os.environ.get("NOTIFY_SOCKET", "").replace("@", "\0", 1)
        self._socket = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        self._socket.setblocking(False)
        watchdog_s = int(os.environ.get("WATCHDOG_USEC") or 3_000_000) / 1e6
        self.beat_s = min(watchdog_s / 3, 1.0)
        """Time between two beats."""
        self._beaten = -self.beat_s
        self._owed = ""
        # The supervisor waits for the end of all services by this lock.
        self._alive = open(group.folder / "alive.lock", "a", encoding="ascii")
        fcntl.flock(self._alive, fcntl.LOCK_SH | fcntl.LOCK_NB)
        if self._lifeline >= 0:
            threading.Thread(target=self._guard, name="lifeline", daemon=True).start()

    def _stop(self, *_: Any) -> None:
        self._is_stopping = True

    def _guard(self) -> None:
        """Ends a service that does not notice that its supervisor is gone."""
        select.select([self._lifeline], [], [])
        time.sleep(ORPHAN_GRACE_S)
        os._exit(1)

    @property
    def ends(self) -> bool:
        """Whether to shut down: on request, or because the supervisor is gone."""
        return self._is_stopping or (self._lifeline >= 0 and bool(select.select([self._lifeline], [], [], 0)[0]))

    def say(self, state: str) -> None:
        """Reports a state once, e.g. `READY=1`. It is kept until there is room for it."""
        self._owed += f"{state}\n"
        self._send("")

    def beat(self) -> None:
        """Sends a beat if one is due. Call it in each pass of the main loop, and from within long work: a
        service that is silent for `watchdog_s` (3 s) is restarted."""
        if time.monotonic() - self._beaten >= self.beat_s:
            self._beaten = time.monotonic()
            self._send("WATCHDOG=1\nX_INPUT_AGE_MS=0\n")

    def _send(self, more: str) -> None:
        try:
            if self._address:
                self._socket.sendto((self._owed + more).rstrip().encode(), self._address)
            self._owed = ""
        except OSError:
            # A full queue: what is owed comes with the next beat.
            pass


class Service:
    """A service of a group. Subclasses open their topics in `open` and handle messages in `step`.

        class Echo(Service):
            name = "echo"

            def open(self):
                self.acts = self.reader("policy/act")

            def step(self):
                for act in self.acts:
                    log(str(act.text))

        Echo().run()

    It may be killed at any moment and starts empty: what has to outlive it belongs into a file that is written
    before anything is published. It must not act on the words of people otherwise than by its messages.
    """

    name: ClassVar[str]
    """Name of the service in the group."""
    poll_s: ClassVar[float] = 0.05
    """Longest time between two passes of a service that no topic wakes."""

    def __init__(self) -> None:
        self.group = Group(environment("WHICHONE_GROUP"), environment("WHICHONE_HOME"))
        self.supervised = Supervised(self.group)
        self.settings = self.group.settings()
        """The settings in force, by section and key."""
        self.bus = Bus(self.group, self.name, epoch=int(environment("WHICHONE_EPOCH")),
                       incarnation=int(environment("WHICHONE_INCARNATION")))
        self._writers: list[Writer] = []
        self._listener: Any = None

    def reader(self, topic: str) -> Reader:
        """Opens a topic for reading."""
        return self.bus.reader(topic)

    def writer(self, topic: str) -> Writer:
        """Opens a topic for writing. Services write the topics that are theirs, and no others."""
        writer = self.bus.writer(topic)
        self._writers.append(writer)
        return writer

    def open(self) -> None:
        """Opens topics, before the service is ready."""

    def step(self) -> None:
        """Handles the messages that have arrived. Called after each wake-up, and from time to time."""
        raise NotImplementedError

    def close(self) -> None:
        """Comes to rest, after the last step."""

    def beat(self) -> None:
        """Sends a beat if one is due; to be called from within work of more than a second."""
        self.supervised.beat()

    @property
    def ends(self) -> bool:
        """Whether the service is asked to end."""
        return self.supervised.ends

    def run(self) -> None:
        """Runs the service until it is asked to end."""
        self._listen()
        try:
            self.open()
        except WrongSchema as error:
            # It will not be another one at the next start.
            print(error, file=sys.stderr)
            raise SystemExit(CONFIG) from None
        self.supervised.say("READY=1")
        while not self.ends:
            self.step()
            self.beat()
            self._wait()
        self.close()
        self.supervised.say("STOPPING=1")

    def _listen(self) -> None:
        try:
            self._listener = self.bus.event(self.name).listener_builder().create()
        except iox2.EventOpenError:
            # No topic wakes it.
            self._listener = None

    def _wait(self) -> None:
        """Sleeps until a wake-up, or until it is time for a beat; serves readers that have joined."""
        if self._listener is None:
            time.sleep(self.poll_s)
            return
        try:
            events = self._listener.timed_wait(iox2.Duration.from_secs_f64(min(self.supervised.beat_s / 2, 0.1)))
        except iox2.ListenerWaitError:
            # A signal interrupts it.
            if not self.ends:
                raise
            return
        joined = max((_number(event) for event in events or ()), default=0)
        if joined:
            for writer in self._writers:
                writer.connect()
                if joined == JOINED_SERVICE:
                    writer.wake()


def _number(event: Any) -> int:
    """Number of a wake-up's event."""
    number = event.id.as_value
    return number() if callable(number) else number


__all__ = ["CONFIG", "STORAGE", "USAGE", "Service", "Supervised", "log"]
