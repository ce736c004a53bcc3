"""Planners: from a belief over the objects to what the robot does next."""

from __future__ import annotations

import json
import sys
from dataclasses import dataclass


@dataclass(frozen=True)
class Question:
    """A question that the robot may ask."""

    number: int
    """Its place in `Problem.questions`."""
    kind: str
    """`attribute` ("Is it white?"), `which` ("What colour is it?"), `choice` ("White or clear?"), or `point` ("This
    one?")."""
    attribute: int | None
    """Number of the attribute in the scene."""
    value: int | None
    """Number of the attribute's value."""
    object: int | None
    """Number of the object that is pointed at."""
    cost: float
    """Its cost, a positive number in the unit of the picks' values."""
    values: list[int]
    """Numbers of the values of a choice, else empty."""
    answers: list[list[float]]
    """For each answer, silence the last, its probability given each object. Those of a yes/no question are yes, no,
    silence; those of a choice its options, "none of these" where that may be true, silence."""


@dataclass(frozen=True)
class Decision:
    """What to do: ask, pick, or, with neither, wait."""

    ask: Question | None = None
    pick: int | None = None
    """Number of the object."""
    value: float | None = None
    """Expected return, shown to the operator."""


@dataclass(frozen=True)
class Problem:
    """A decision: everything that it may depend on."""

    belief: list[float]
    """Probability of each object, in the order of the scene. Where the scene may lack the wanted object, the last one
    is that it does: it cannot be picked."""
    questions: list[Question]
    correct: float
    """Value of a right pick."""
    wrong: float
    """Value of a wrong pick, negative."""
    wait: float
    """Value of waiting."""
    discount: float
    """Of what comes after an action."""
    interaction: int
    """Number of the interaction; with `step` the only source of randomness."""
    step: int
    """Number of the decision in the interaction."""

    def pick_value(self, probability: float) -> float:
        """The expected value of picking an object of this probability."""
        return probability * self.correct + (1.0 - probability) * self.wrong

    def outcomes(self, question: Question) -> list[tuple[float, list[float]]]:
        """For each answer that the question may get, its probability and the belief after it."""
        found = []
        for likelihood in question.answers:
            joint = [p * given for p, given in zip(self.belief, likelihood)]
            total = sum(joint)
            if total > 0.0:
                found.append((total, [p / total for p in joint]))
        return found


class Planner:
    """A planner as a program of the policy service: `whichone-policy --planner-program python3 FILE`.

    Subclasses decide in `decide`, by the problem alone: the same problem gives the same decision, so that the journal can be
    verified. A decision takes 1.5 s at most. Where `decide` fails or is late, the planner `entropy` decides, the log of the
    policy has the reason, and the program is started again.
    """

    def decide(self, problem: Problem) -> Decision:
        """What to do."""
        raise NotImplementedError

    def run(self) -> None:
        """Answers until the policy service ends. What is printed meanwhile is in its log."""
        answers, sys.stdout = sys.stdout, sys.stderr
        print("ready", file=answers, flush=True)
        for line in sys.stdin:
            request = json.loads(line)
            questions = [
                Question(number, it["kind"], it.get("attribute"), it.get("value"), it.get("object"), it["cost"],
                         it.get("values", []), it["answers"])
                for number, it in enumerate(request.pop("questions"))]
            decision = self.decide(Problem(questions=questions, **request))
            reply = {"ask": decision.ask and decision.ask.number, "pick": decision.pick, "value": decision.value}
            print(json.dumps({key: it for key, it in reply.items() if it is not None}), file=answers, flush=True)
