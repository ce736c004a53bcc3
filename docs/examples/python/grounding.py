"""Grounding in Python: spots the scene's own words, yes and no, as the paper does (section 3.6).

    pip install iceoryx2==0.10.0
    whichone swap grounding -- python3 docs/examples/python/grounding.py

It remembers nothing, so it can be killed and swapped at any moment, as the one that it replaces.
"""

import os
import re
import sys
import time
import tomllib

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import iceoryx2 as iox2
from wire import BEAT_S, Bond, Bus, Layout, fnv1a

LAYOUT = os.path.join(os.path.dirname(os.path.abspath(__file__)),
                      "../../../tests/golden/wire_layout.txt")
AFFIRMATIVE = {"yes", "yeah", "sure", "yup", "yep"}
NEGATIVE = {"no", "nope", "not", "nah", "other"}
YES, NO, INFORM = 1, 2, 0
# The question of a reading that answers none, as in `shared/messages`.
NO_QUESTION = 255
WORDS = re.compile(r"[^\W_]+(?:[-'][^\W_]+)*")


class Scene:
    """The scene as grounding needs it: its words in order, and the key of its problem."""

    def __init__(self, text):
        scene = tomllib.loads(text)
        named = lambda value: value if isinstance(value, str) else value["name"]
        values = {a["name"]: [named(v) for v in a["values"]] for a in scene["attributes"]}
        words = dict.fromkeys(value for of in values.values() for value in of)
        self.words, self.values = list(words), values
        self.objects = [thing["name"] for thing in scene["objects"]]
        self.phrases = [(WORDS.findall(word.lower()), number) for number, word in enumerate(words)]
        self.phrases.sort(key=lambda phrase: -len(phrase[0]))
        self.key = self._key(values, scene["objects"])

    @staticmethod
    def _key(values, objects):
        """The hash of objects, attributes and values: `shared/scene/src/key.rs`."""
        count = lambda n: n.to_bytes(8, "little")
        text = lambda t: count(len(t.encode())) + t.encode()
        parts = [count(len(values))]
        for name, listed in values.items():
            parts += [text(name), count(len(listed)), *map(text, listed)]
        parts.append(count(len(objects)))
        for thing in objects:
            parts.append(text(thing["name"]))
            for name, listed in values.items():
                value = thing.get("attributes", {}).get(name)
                parts.append(count(0 if value is None else listed.index(value) + 1))
        return fnv1a(b"".join(parts))

    def read(self, text):
        """The words that were said, each as its number and its blank-separated word's place, and
        yes, no or neither."""
        found = list(WORDS.finditer(text.lower()))
        said = [match.group() for match in found]
        places = [len(text[:match.start()].split(" ")) - 1 for match in found]
        base, at = [], 0
        while at < len(said):
            fits = (p for p in self.phrases if p[0] and said[at:at + len(p[0])] == p[0])
            phrase, word = next(fits, ([None], None))
            base += [] if word is None else [(word, places[at])]
            at += len(phrase)
        yes, no = (not words.isdisjoint(said) for words in (AFFIRMATIVE, NEGATIVE))
        return base, 0 if yes == no else YES if yes else NO


def hypotheses(utterance):
    """Yields each recognition hypothesis: text, weight, and the doubt of each blank-separated word."""
    text = bytes(utterance.text.bytes)[:utterance.text.len]
    for heard in utterance.hypotheses[:utterance.hypothesis_count]:
        words = text[heard.start:heard.start + heard.len].decode()
        yield words, heard.weight, [1.0 - sure / 255 for sure in heard.confidence]


def empty(layout, scene, utterance):
    """The observation of an utterance, without readings."""
    observation = layout.structs["Observation"]()
    for field, _ in observation._fields_:
        # Fields that both messages have are copied: utterance, questions, gesture.
        if field != "reserved" and hasattr(utterance, field):
            setattr(observation, field, getattr(utterance, field))
    observation.scene_key = scene.key
    observation.grounded_ns = time.monotonic_ns()
    return observation


def places(utterance):
    """Each question that the utterance may answer, by its place, and none."""
    return [*range(utterance.asked_count), NO_QUESTION]


def observe(layout, scene, utterance):
    """The observation of an utterance: each hypothesis for each question and for none. This
    reader ignores the question, so the readings differ in their question alone."""
    observation = empty(layout, scene, utterance)
    heard = list(hypotheses(utterance))
    readings = [(place, *said) for place in places(utterance) for said in heard]
    if not heard and utterance.gesture.present:
        # A pointing gesture without words: one reading, without a word.
        readings = [(NO_QUESTION, "", 1.0, [])]
    observation.reading_count = len(readings)
    for reading, (place, text, weight, doubts) in zip(observation.readings, readings):
        base, response = scene.read(text)
        base = base[:len(reading.base)]
        reading.question, reading.weight = place, weight
        reading.response, reading.intent = response, INFORM
        reading.base_count = len(base)
        for n, (word, at) in enumerate(base):
            reading.base[n] = word
            reading.base_doubt[n] = doubts[at] if at < len(doubts) else 0.0
    return observation


def serve(observe_one):
    """Runs the service: one observation per utterance, until it is asked to shut down."""
    bond = Bond()
    layout = Layout(LAYOUT)
    bus = Bus(layout, "grounding")
    with open(os.path.join(bus.root, "run", "settings.toml"), "rb") as snapshot:
        scene = Scene(tomllib.load(snapshot)["scene"]["text"])
    ear = bus.event("grounding").listener_builder().create()
    bell = bus.event("policy").notifier_builder().create()
    utterances = bus.topic("speech/utterance", "Utterance").subscriber_builder().create()
    observations = bus.topic("grounding/observation", "Observation").publisher_builder()
    observations = observations.backpressure_strategy(iox2.BackpressureStrategy.DiscardData).create()
    ready = False
    while not bond.ends():
        ready = ready or bond.say("READY=1\n")
        try:
            ear.timed_wait(iox2.Duration.from_secs_f64(BEAT_S / 2))
        except iox2.ListenerWaitError:
            # A signal interrupts it.
            if not bond.ends():
                raise
        for utterance in bus.receive(utterances):
            bus.send(observations, observe_one(layout, scene, utterance, bond))
            bell.notify()
        bond.beat()
    bond.say("STOPPING=1\n")


if __name__ == "__main__":
    serve(lambda layout, scene, utterance, _: observe(layout, scene, utterance))
