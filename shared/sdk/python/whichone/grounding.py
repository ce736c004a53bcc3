"""Grounding services: from an utterance to what it says about the scene."""

from __future__ import annotations

import math
import time
from collections import OrderedDict
from dataclasses import dataclass, field
from typing import ClassVar, Sequence

from . import messages as m
from .bus import log
from .scene import WORDS, Scene
from .service import Service

AFFIRMATIVE = frozenset({"yes", "yeah", "sure", "yup", "yep"})
NEGATIVE = frozenset({"no", "nope", "not", "nah", "other"})


@dataclass(frozen=True)
class Hypothesis:
    """One wording that may have been said."""

    text: str
    weight: float
    """Probability among the hypotheses; these sum to 1."""
    doubts: list[float]
    """For each blank-separated word, the probability that it was not said; certain words at the end may be left
    out."""

    def doubt(self, place: int) -> float:
        """The doubt of the word at this place."""
        return self.doubts[place] if place < len(self.doubts) else 0.0


@dataclass(frozen=True)
class Heard:
    """An utterance, with the questions that it may answer."""

    seq: int
    """Number of the utterance. It is sent again under its number until it is applied."""
    hypotheses: list[Hypothesis]
    """Wordings, most likely first; empty for a pointing gesture without words."""
    questions: list[m.WireQuestion]
    """The questions that it may answer, newest first. One about another scene has kind 0: read the utterance as
    if it had not been asked."""
    target_m: tuple[float, float, float] | None
    """The point that is pointed at, metres, frame `base`."""

    @property
    def text(self) -> str:
        """The likeliest wording; may be empty."""
        return self.hypotheses[0].text if self.hypotheses else ""


@dataclass
class Reading:
    """One possible meaning of an utterance."""

    base: list[str] = field(default_factory=list)
    """Words of the scene that describe the wanted object."""
    response: m.Response = m.Response.NONE
    """The answer to the question."""
    question: int | None = None
    """Place in `Heard.questions` of the question that it answers; none if it answers none."""
    weight: float = 1.0
    """Relative weight among the readings for the same question."""
    intent: m.Intent = m.Intent.INFORM
    """Purpose of the utterance."""
    excluded: list[list[str]] = field(default_factory=list)
    """Groups of words: an object that has all words of a group is ruled out."""
    further: list[list[str]] = field(default_factory=list)
    """Groups of words, one for each further object asked for."""
    refers: m.Reference = m.Reference.NONE
    """An object pointed to by what was spoken of."""
    base_doubt: list[float] = field(default_factory=list)
    """For each word of `base`, the probability that it was not said or meant."""
    excluded_doubt: list[float] = field(default_factory=list)
    """The same for each group of `excluded`."""
    response_doubt: float = 0.0
    """The same for the response."""


@dataclass
class Meaning:
    """The readings of an utterance, with a word that the scene does not have."""

    readings: Sequence[Reading]
    unknown: str = ""
    """The word, for the robot's reply: "wooden", "plate"."""
    role: m.Role = m.Role.QUALITY
    """What it is: a quality, a place, or a kind of thing."""


def heard(utterance: m.Utterance, scene: Scene) -> Heard:
    """What an utterance's message says. Raises `InvalidMessage` for one that makes no sense."""
    if utterance.hypothesis_count > m.HYPOTHESES_MAX or utterance.asked_count > m.ASKED_MAX:
        raise m.InvalidMessage(f"utterance {utterance.seq}: expected {m.HYPOTHESES_MAX} hypotheses and {m.ASKED_MAX} "
                               f"questions at most, found {utterance.hypothesis_count} and {utterance.asked_count}")
    text = bytes(utterance.text.bytes[:utterance.text.len])
    hypotheses = []
    for it in utterance.hypotheses[:utterance.hypothesis_count]:
        words = text[it.start:it.start + it.len]
        if len(words) != it.len:
            raise m.InvalidMessage(f"utterance {utterance.seq}: a hypothesis ends after the text")
        if not (math.isfinite(it.weight) and it.weight >= 0.0):
            raise m.InvalidMessage(f"utterance {utterance.seq}: expected weights of 0 or more, found {it.weight}")
        doubts = [1.0 - sure / 255 for sure in it.confidence]
        hypotheses.append(Hypothesis(words.decode(errors="replace"), it.weight, doubts))
    questions = [it.question if it.scene == scene.key else m.WireQuestion()
                 for it in utterance.asked[:utterance.asked_count]]
    target = tuple(utterance.gesture.target_m) if utterance.gesture.present else None
    return Heard(utterance.seq, hypotheses, questions, target)


def spot(heard: Heard, scene: Scene) -> list[Reading]:
    """Reads an utterance by spotting the scene's own words, yes and no. It needs no model and never fails, so it
    is what an utterance is read by where another reader does."""
    readings = []
    for hypothesis in heard.hypotheses:
        words = scene.spot(hypothesis.text)
        said = {match.group() for match in WORDS.finditer(hypothesis.text.lower())}
        yes, no = bool(said & AFFIRMATIVE), bool(said & NEGATIVE)
        response = m.Response.NONE if yes == no else m.Response.YES if yes else m.Response.NO
        readings.append(Reading([word for word, _ in words], response, weight=hypothesis.weight,
                                base_doubt=[hypothesis.doubt(place) for _, place in words]))
    return readings


def observation(utterance: m.Utterance, meaning: Sequence[Reading] | Meaning, scene: Scene) -> m.Observation:
    """The message that states the meaning of an utterance.

    For each question the weights are made to sum to 1. A question without readings gets those that answer none.
    Raises `ValueError` for words, numbers or questions that make no sense, and names them.
    """
    meaning = meaning if isinstance(meaning, Meaning) else Meaning(meaning)
    message, readings = m.Observation(), meaning.readings
    message.unknown.set(meaning.unknown)
    message.unknown_role = m.Role(meaning.role)
    for name, _ in message._fields_:
        # Fields that both messages have are copied: utterance, questions, gesture, times.
        if name != "reserved" and hasattr(utterance, name):
            setattr(message, name, getattr(utterance, name))
    message.scene_key, message.grounded_ns = scene.key, time.monotonic_ns()
    by_place: dict[int | None, list[Reading]] = {place: [] for place in (*range(utterance.asked_count), None)}
    for reading in readings or [Reading(intent=m.Intent.INFORM if utterance.gesture.present else m.Intent.NONE)]:
        if reading.question not in by_place:
            raise ValueError(f"expected a question from 0 to {utterance.asked_count - 1} or none, "
                             f"found {reading.question}")
        if not (math.isfinite(reading.weight) and reading.weight >= 0.0):
            raise ValueError(f"expected a weight of 0 or more, found {reading.weight}")
        by_place[reading.question].append(reading)
    most, count = m.READINGS_MAX // len(by_place), 0
    for place, own in by_place.items():
        own = own or by_place[None] or [Reading(intent=m.Intent.NONE)]
        own = sorted(own, key=lambda reading: -reading.weight)[:most]
        total = sum(reading.weight for reading in own)
        if total <= 0.0:
            raise ValueError("expected weights of which one is above 0")
        for reading in own:
            _fill(message.readings[count], reading, scene)
            message.readings[count].question = m.NO_QUESTION if place is None else place
            message.readings[count].weight = reading.weight / total
            count += 1
    message.reading_count = count
    return message


def _fill(slot: m.WireReading, reading: Reading, scene: Scene) -> None:
    base = [scene.word(word) for word in reading.base][:m.BASE_WORDS_MAX]
    slot.base_count, slot.base[:len(base)] = len(base), base
    for n, doubt in enumerate(reading.base_doubt[:len(base)]):
        slot.base_doubt[n] = _share(doubt)
    slot.excluded_count = _fill_groups(slot.excluded, slot.excluded_len, reading.excluded, scene)
    slot.further_count = _fill_groups(slot.further, slot.further_len, reading.further, scene)
    for n, doubt in enumerate(reading.excluded_doubt[:slot.excluded_count]):
        slot.excluded_doubt[n] = _share(doubt)
    slot.response_doubt = _share(reading.response_doubt)
    slot.response = m.Response(reading.response)
    slot.intent, slot.refers = m.Intent(reading.intent), m.Reference(reading.refers)


def _fill_groups(slots: m.Array, lengths: m.Array, groups: list[list[str]], scene: Scene) -> int:
    # A group that lost a word would rule out more.
    fitting = [group for group in groups if 0 < len(group) <= m.EXCLUDED_WORDS_MAX][:len(slots)]
    for n, group in enumerate(fitting):
        lengths[n], slots[n][:len(group)] = len(group), [scene.word(word) for word in group]
    return len(fitting)


def _share(number: float) -> float:
    if not 0.0 <= number <= 1.0:
        raise ValueError(f"expected a probability, found {number}")
    return float(number)


class Grounder(Service):
    """A grounding service. Subclasses give an utterance's meaning in `ground`.

    Every utterance gets an observation. Where `ground` fails, the utterance is read by word spotting, and the log
    says why. An utterance that is sent again gets the same observation.
    """

    name: ClassVar[str] = "grounding"
    remembered: ClassVar[int] = 64
    """Utterances whose observations are kept, for those that are sent again."""

    def __init__(self) -> None:
        super().__init__()
        self.scene = Scene.parse(self.settings["scene"]["text"])
        """The scene in force."""
        self._known: OrderedDict[tuple[int, bytes], m.Observation] = OrderedDict()

    def ground(self, heard: Heard) -> Sequence[Reading] | Meaning:
        """The possible meanings of an utterance; a `Meaning` where it names what the scene does not have.

        Readings that leave out `question` count for every question. Takes about a second at most, and calls `beat`
        meanwhile where it may take longer.
        """
        raise NotImplementedError

    def open(self) -> None:
        self.utterances = self.reader("speech/utterance")
        self.observations = self.writer("grounding/observation")

    def step(self) -> None:
        for utterance in self.utterances:
            self.observations.send(self._observe(utterance))
            self.beat()

    def _observe(self, utterance: m.Utterance) -> m.Observation:
        # Other questions may have been asked since it was sent first.
        key = (utterance.seq, bytes(utterance))
        if key not in self._known:
            self._known[key] = self._read(utterance)
            while len(self._known) > self.remembered:
                self._known.popitem(last=False)
        return self._known[key]

    def _read(self, utterance: m.Utterance) -> m.Observation:
        try:
            words = heard(utterance, self.scene)
        except m.InvalidMessage as error:
            log(f"{error}; it counts as without content")
            words = Heard(utterance.seq, [], [], None)
            utterance.asked_count = min(utterance.asked_count, m.ASKED_MAX)
        for read, instead in ((self.ground, "word spotting"), (lambda it: spot(it, self.scene), "no content")):
            try:
                return observation(utterance, read(words), self.scene)
            except Exception as error:
                if self.ends:
                    raise
                log(f"utterance {utterance.seq}: {type(error).__name__}: {error}; read as {instead}")
        return observation(utterance, [], self.scene)
