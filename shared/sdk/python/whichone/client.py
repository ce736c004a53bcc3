"""A client of a running group: says, watches, waits, and stops the motion."""

from __future__ import annotations

import os
import secrets
import time
from dataclasses import dataclass
from types import TracebackType
from typing import Iterator, Sequence

from . import _stop
from . import messages as m
from ._stop import NotStopped
from .bus import Bus
from .group import Group, GroupNotRunning
from .scene import Scene

RESEND_S = 0.25
"""Time between two transmissions of a request that has no receipt yet."""
LOOK_S = 0.005
"""Time between two looks at the topics."""
SETTLED_LOOKS = 3
"""Looks that must find everything applied: the parts of one step are not published at once."""


class Refused(ValueError):
    """The robot has refused what was said; the message is its reason."""


class NoPick(RuntimeError):
    """What was said opened no interaction; the message is the robot's answer."""


@dataclass(frozen=True)
class Snapshot:
    """The state of the dialogue and the arm."""

    view: m.PolicyView | None
    """Belief, question and decision of the robot."""
    arm: m.ArmStatus | None
    """State of the arm."""
    presented: m.Presented | None
    """Progress of the robot's latest line."""
    activity: m.Activity | None
    """Utterances that are not applied yet."""
    scene: Scene
    """The scene, for the names of objects and words."""

    @property
    def open_question(self) -> m.Question | None:
        """The question that waits for an answer: said to its end, and with nothing on its way that may answer it.
        Where the robot asks for a confirmation, it is what it wants to be confirmed."""
        view, presented, activity = self.view, self.presented, self.activity
        if view is None or presented is None or activity is None or activity.pending or not view.interaction:
            return None
        is_confirmation = view.decision == m.ActKind.SAY and view.question != m.QuestionNone()
        is_presented = presented.prompt == view.prompt and presented.state == m.PresentationState.ENDED
        return view.question if is_presented and (view.decision == m.ActKind.ASK or is_confirmation) else None

    @property
    def belief(self) -> dict[str, float]:
        """Probability of each object of the scene by its name."""
        if self.view is None or self.view.objects:
            return {}
        return dict(zip(self.scene.objects, self.view.belief))


class Client:
    """A client of a running group. It belongs to one thread.

        with Client() as robot:
            robot.say("get me the bowl")
            print(robot.await_pick(timeout=60).name)
    """

    def __init__(self, group: str | None = None, home: str | os.PathLike[str] | None = None) -> None:
        """Joins the group of that name. Raises `GroupNotRunning`."""
        self.group = Group(group, home)
        self.scene = self.group.scene()
        self.bus = Bus(self.group, "client")
        self._identity = secrets.token_bytes(8)
        self._injections = self.bus.writer("speech/inject")
        self._receipts = self.bus.reader("speech/receipt")
        self._views, self._statuses = self.bus.reader("policy/view"), self.bus.reader("arm/status")
        self._activities = self.bus.reader("speech/activity")
        self._presentations = self.bus.reader("speech/presented")
        self._view: m.PolicyView | None = None
        self._arm: m.ArmStatus | None = None
        self._activity: m.Activity | None = None
        self._presented: m.Presented | None = None
        self._said = 0
        self._reported = 0

    def __enter__(self) -> Client:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None,
                 trace: TracebackType | None) -> None:
        self.close()

    def close(self) -> None:
        """Leaves the group."""
        self.__dict__.clear()

    def look(self) -> Snapshot:
        """The latest state. Its parts are none until their services have published."""
        # Pending utterances before the view, which is the newer of both.
        self._activity = self._activities.latest() or self._activity
        self._arm = self._statuses.latest() or self._arm
        self._presented = self._presentations.latest() or self._presented
        self._view = self._views.latest() or self._view
        return Snapshot(self._view, self._arm, self._presented, self._activity, self.scene)

    def watch(self, every_s: float = LOOK_S) -> Iterator[Snapshot]:
        """Yields the state now and after each change. It ends when the group does."""
        before = None
        while (self.group.run / "control.sock").exists():
            now = self.look()
            parts = (now.arm, now.presented, now.activity)
            state = (now.view, *(part and bytes(part) for part in parts))
            if state != before:
                before = state
                yield now
            time.sleep(every_s)

    def say(self, text: str, *, from_: str = "", seen: int | None = None, timeout: float = 10.0) -> int:
        """Says something to the robot, as if typed. It answers the line `seen`, a `prompt` of `look()` that the person
        was shown last; by default the robot's latest one. `from_` is the name of the person who speaks, at most 64
        bytes. Returns the utterance's number once it is durable: it will be applied once, whatever is killed. Raises
        `Refused` or `TimeoutError`."""
        return self._deliver(m.SoundText(text), from_, seen, timeout)

    def point(self, xyz: Sequence[float], words: str = "", *, from_: str = "", seen: int | None = None,
              timeout: float = 10.0) -> int:
        """Points at a place (metres, frame `base`), with words or without. Otherwise as `say`."""
        return self._deliver(m.SoundPoint(target_m=[float(x) for x in xyz], words=words), from_, seen, timeout)

    def hypotheses(self, wordings: Sequence[tuple[str, float]], *, from_: str = "", seen: int | None = None,
                   timeout: float = 10.0) -> int:
        """Says what a recogniser has heard: wordings with their weights, most likely first. Otherwise as `say`."""
        heard = [m.Hypothesis(text=text, weight=weight, word_confidence=[]) for text, weight in wordings]
        return self._deliver(m.SoundTranscript(hypotheses=heard), from_, seen, timeout)

    def _deliver(self, sound: m.Sound, from_: str, seen: int | None, timeout: float) -> int:
        key = self._identity + secrets.token_bytes(8)
        now = self.look()
        latest = max((part.prompt for part in (now.view, now.presented) if part), default=0)
        seen = latest if seen is None else seen
        injection = m.Injection(key=key, onset_ns=0, end_ns=0, seen_prompt=seen, from_=from_, sound=sound)
        until, due = time.monotonic() + timeout, 0.0
        while (now := time.monotonic()) < until:
            if now >= due:
                # Under one key, so that a restart in between neither loses nor doubles it.
                self._injections.send(injection)
                due = now + RESEND_S
            for receipt in self._receipts:
                if bytes(receipt.key) != key:
                    continue
                if receipt.status != m.ReceiptStatus.ACCEPTED:
                    raise Refused(str(receipt.note))
                self._said = receipt.seq
                return receipt.seq
            time.sleep(LOOK_S / 5)
        self._check_group()
        raise TimeoutError(f"speech: no receipt within {timeout:g} s; help: see `whichone status`")

    def _check_group(self) -> None:
        if not (self.group.run / "control.sock").exists():
            raise self.group.not_running()

    def await_pick(self, timeout: float | None = None) -> m.Ended:
        """Waits for the end of the interaction that is open, or that what was said opens; where neither is, for
        that of the latest or the next one. Raises `NoPick` if what was said opened none, `TimeoutError`, or
        `GroupNotRunning`."""
        until = None if timeout is None else time.monotonic() + timeout
        goal, settled = 0, 0
        while until is None or time.monotonic() < until:
            view = self.look().view
            if view is not None and self._is_settled(view) and not goal:
                settled += 1
                if view.interaction:
                    goal = view.interaction
                elif settled >= SETTLED_LOOKS:
                    last = view.last
                    if last is not None and last.interaction > self._reported and last.utterances[1] >= self._said:
                        return self._report(last)
                    if self._said > max(view.utterances[1], last.utterances[1] if last else 0):
                        self._said = 0
                        raise NoPick(view.text or "the words asked for no object that is here")
            elif goal and view is not None and view.last is not None and view.last.interaction >= goal:
                return self._report(view.last)
            time.sleep(LOOK_S)
            self._check_group()
        raise TimeoutError(f"no interaction has ended within {timeout:g} s; help: see `whichone watch`")

    def _report(self, ended: m.Ended) -> m.Ended:
        self._reported, self._said = ended.interaction, 0
        return ended

    def _is_settled(self, view: m.PolicyView) -> bool:
        """Whether everything that was said is applied, and no sound is still being recognised."""
        return view.applied >= self._said and self._activity is not None and self._activity.pending == 0

    def stop(self, timeout: float | None = None) -> None:
        """Stops the arm and latches the stop; returns once the arm is at rest. The order is repeated for as long as
        the group runs, or for `timeout` seconds, and the logger `whichone` warns while it is not confirmed. Raises
        `NotStopped`: use the robot's own emergency stop then."""
        _stop.give(self.group, "stop", timeout)

    def resume(self, timeout: float = 5.0, *, stop: int = 0) -> None:
        """Releases the motion stop. `stop` is the one that the person saw, `look().arm.stop`: if another one has been
        given since, it holds. 0 stands for any. Raises `NotStopped`."""
        _stop.give(self.group, "resume", timeout, stop)


__all__ = ["Client", "GroupNotRunning", "NoPick", "NotStopped", "Refused", "Snapshot"]
