"""Clients and services for whichone, a robot that asks which object you mean before it fetches it.

A client says something to a running group and waits for the object:

    from whichone import Client

    with Client() as robot:
        robot.say("get me the clear bowl")
        print(robot.await_pick(timeout=60).name)

A grounding service of one's own takes the place of the built-in one with `whichone swap grounding -- python3 FILE`:

    from whichone import Grounder, Reading

    class Mine(Grounder):
        def ground(self, heard):
            return [Reading(base=[word for word in self.scene.words if word in heard.text])]

    Mine().run()

`docs/sdk-python.md` in the repository has more.
"""

from . import messages
from ._fixed import InvalidMessage
from .bus import Bus, Reader, WrongSchema, Writer, log
from .client import Client, NoPick, NotStopped, Refused, Snapshot
from .grounding import Grounder, Heard, Hypothesis, Meaning, Reading, spot
from .group import Group, GroupNotRunning
from .messages import Intent, Reference, Response, Role
from .planner import Decision, Planner, Problem, Question
from .scene import Scene
from .service import Service

__version__ = "0.1.0"
__all__ = [
    "Bus", "Client", "Decision", "Grounder", "Group", "GroupNotRunning", "Heard", "Hypothesis", "Intent", "InvalidMessage",
    "Meaning", "NoPick", "NotStopped", "Planner", "Problem", "Question", "Reader", "Reading", "Reference", "Refused", "Response", "Role", "Scene",
    "Service", "Snapshot", "Writer", "WrongSchema", "log", "messages", "spot",
]
