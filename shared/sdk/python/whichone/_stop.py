"""Orders to the motion stop, on the stop's own path: datagrams on a socket of the arm's service."""

from __future__ import annotations

import json
import logging
import os
import socket
import struct
import threading
import time
from typing import Any

from .group import Group

RESEND_S = 0.01
"""Time between two repetitions of an order."""
SILENCE_S = 0.25
"""Time without an answer before a warning; the lack of a process counts at once."""
HALTS_WITHIN_S = 1.0
"""Time for an arm that has answered to come to rest, before a warning."""
WARN_EVERY_S = 3.0
"""Time between two warnings."""
DURABLE_GRACE_S = 0.5
"""Time for a stop of an arm at rest to become durable."""
HEARD_GRACE_S = 1.0
"""Time for the robot to be heard, which an arm that has just started needs."""
RESUME_AFTER_S = 2.0
"""Time after a stop in which no release counts."""
EMERGENCY = "help: use the robot's own emergency stop, then see `whichone status`"
MACHINE_CLOCK = "/proc/self/timens_offsets"

log = logging.getLogger("whichone")


class NotStopped(RuntimeError):
    """An order to the motion stop is not carried out, or not known to be."""


class Order:
    """Progress of one order, without a clock and a socket of its own."""

    def __init__(self, order: str, given: float, timeout: float | None, stop: int = 0) -> None:
        self.order, self.given, self.timeout, self.stop = order, given, timeout, stop
        self.is_absent = False
        self.state: dict[str, Any] | None = None
        self.rests_since: float | None = None
        self.unheard_since: float | None = None
        self.warned: float | None = None

    def on_sent(self, is_absent: bool) -> None:
        """Notes whether a process listened. One that has ended may have lost what it answered."""
        self.is_absent = is_absent
        if is_absent:
            self.state = self.rests_since = self.unheard_since = None

    def on_answer(self, state: dict[str, Any], now: float) -> None:
        """Takes in an answer to this order."""
        is_heard = state["inhibit"] not in ("unheard", "stale")
        rests = state["stopped"] and state["at_rest"] and is_heard
        self.rests_since = (now if self.rests_since is None else self.rests_since) if rests else None
        is_unheard = state["stopped"] and not is_heard
        self.unheard_since = (now if self.unheard_since is None else self.unheard_since) if is_unheard else None
        self.state = state

    def is_done(self, now: float) -> bool:
        """Whether the order is carried out. Raises `NotStopped` if it is over without."""
        is_late = self.timeout is not None and now - self.given >= self.timeout
        if self.state is not None:
            if self.order == "resume" and not self.state["stopped"]:
                return True
            if self.order == "stop" and self.rests_since is not None:
                return self.state["durable"] or is_late or now - self.rests_since >= DURABLE_GRACE_S
            if self.stop and self.state.get("stop", 0) not in (0, self.stop):
                raise NotStopped("another stop was given after the one that this releases, and holds; "
                                 "help: see why the arm was stopped again, then release that stop, "
                                 "or run: whichone resume-motion")
            if self.state["stopped"] != (self.order == "stop") and self.state["in_force_ns"] > self.state["given_ns"]:
                raise NotStopped("overruled by a later order; help: see `whichone watch`")
            if self.order == "resume" and self.state["in_force_ns"] + RESUME_AFTER_S * 1e9 > self.state["given_ns"]:
                raise NotStopped(f"a stop was given less than {RESUME_AFTER_S:.0f} s before the release; "
                                 "help: give the release again")
        is_unheard = self.unheard_since is not None and now - self.unheard_since >= HEARD_GRACE_S
        if is_late or (self.order == "stop" and is_unheard):
            raise NotStopped(self.why(now))
        return False

    def warning(self, now: float) -> str | None:
        """Why the order is not confirmed, where a warning is due."""
        if self.warned is not None:
            is_due = now - self.warned >= WARN_EVERY_S
        else:
            is_due = self.is_absent or now - self.given >= (SILENCE_S if self.state is None else HALTS_WITHIN_S)
        if not is_due or self.rests_since is not None:
            return None
        self.warned = now
        return self.why(now)

    def why(self, now: float) -> str:
        """Why the order is not confirmed."""
        waited = f"{now - self.given:.1f} s"
        if self.state is None and self.is_absent:
            return f"the arm's service is not running; the robot may still move; {EMERGENCY}"
        if self.state is None:
            return f"the arm's service does not answer after {waited}; the robot may still move; {EMERGENCY}"
        if self.state["stopped"] != (self.order == "stop"):
            return (f"the arm has not taken the order after {waited} (motion inhibited: {self.state['inhibit']}); "
                    "help: reset and enable the robot, then give the order again")
        if self.unheard_since is not None:
            return f"the stop is latched, but the robot is not heard and may still move; {EMERGENCY}"
        return f"the arm is stopping but not at rest after {waited}; {EMERGENCY}"


def give(group: Group, order: str, timeout: float | None, stop: int = 0) -> None:
    """Repeats an order until the arm has carried it out; for at most `timeout` seconds, if it is given. A release is
    of `stop` alone, 0 stands for any. A stop that is left unconfirmed is kept for the arm's return. Raises `NotStopped`
    or `GroupNotRunning`."""
    given_ns = time.monotonic_ns()
    progress = Order(order, given_ns / 1e9, timeout, stop)
    stamp = max(given_ns - _clock_offset_ns(), 1)
    request = json.dumps({"order": order, "given_ns": stamp} | ({"stop": stop} if stop else {})).encode()
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as arm:
        # Both sides check who the other one is.
        arm.setsockopt(socket.SOL_SOCKET, socket.SO_PASSCRED, 1)
        arm.bind("")
        arm.settimeout(RESEND_S)
        try:
            _repeat(arm, request, progress, group)
        except BaseException:
            if order == "stop" and (progress.state is None or not progress.state["stopped"]):
                _keep(group, stamp)
            raise


def _repeat(arm: socket.socket, request: bytes, progress: Order, group: Group) -> None:
    """Repeats an order until it is carried out."""
    stamp = json.loads(request)["given_ns"]
    is_kept = False
    while not progress.is_done(time.monotonic()):
        progress.on_sent(not _send(arm, request, group))
        answer = None if progress.is_absent else _receive(arm, group)
        if answer is not None and answer.get("given_ns") == stamp:
            progress.on_answer(answer, time.monotonic())
        if why := progress.warning(time.monotonic()):
            log.warning("not confirmed: %s; the order is repeated", why)
        is_open = progress.order == "stop" and (progress.state is None or not progress.state["stopped"])
        if is_open and not is_kept and (progress.is_absent or time.monotonic() - progress.given >= SILENCE_S):
            is_kept = True
            threading.Thread(target=_keep, args=(group, stamp), daemon=True).start()
        if progress.is_absent or answer is not None:
            time.sleep(RESEND_S)
    if is_kept:
        (group.run.parent / "stop.kept").unlink(missing_ok=True)


def _keep(group: Group, given_ns: int) -> None:
    """Leaves a stop for the arm's service, which obeys it before it moves. The latest one is kept."""
    file = group.run.parent / "stop.kept"
    draft = file.with_name(f"stop.kept.{os.getpid()}.{threading.get_ident()}")
    if not file.parent.is_dir():
        return
    try:
        if file.exists() and int(file.read_text(encoding="ascii") or given_ns) >= given_ns:
            return
    except (OSError, ValueError):
        return
    try:
        with open(os.open(draft, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "w", encoding="ascii") as new:
            new.write(f"{given_ns}\n")
        draft.rename(file)
    except OSError as error:
        log.warning("stop not kept for the arm's return: %s", error)


def _send(arm: socket.socket, request: bytes, group: Group) -> bool:
    """Returns whether a process listens. A full queue drops the order, which is repeated anyway."""
    try:
        arm.sendto(request, str(group.run / "stop.sock"))
    except (FileNotFoundError, ConnectionRefusedError):
        if not group.run.is_dir():
            raise group.not_running() from None
        return False
    except (BlockingIOError, TimeoutError):
        pass
    return True


def _receive(arm: socket.socket, group: Group) -> dict[str, Any] | None:
    """Returns the next answer of root, this user, or the user whom the group belongs to."""
    credentials = struct.Struct("3i")
    try:
        data, control, _, _ = arm.recvmsg(512, socket.CMSG_SPACE(credentials.size))
    except TimeoutError:
        return None
    users = {0, os.geteuid()}
    if os.geteuid() == 0 and group.run.is_dir():
        users.add(group.run.stat().st_uid)
    senders = [credentials.unpack(part)[1] for level, kind, part in control
               if (level, kind) == (socket.SOL_SOCKET, socket.SCM_CREDENTIALS)]
    if not any(sender in users for sender in senders):
        return None
    try:
        answer = json.loads(data)
    except ValueError:
        return None
    return answer if isinstance(answer, dict) else None


def _clock_offset_ns() -> int:
    """Offset of this process's monotonic clock from the machine's, which a container may have."""
    try:
        with open(MACHINE_CLOCK, encoding="ascii") as offsets:
            for line in offsets:
                name, seconds, nanoseconds = line.split()
                if name == "monotonic":
                    return int(seconds) * 1_000_000_000 + int(nanoseconds)
    except (OSError, ValueError):
        pass
    return 0
