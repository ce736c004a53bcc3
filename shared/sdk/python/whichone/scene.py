"""The scene as clients and grounding services need it: its objects, and its words with their numbers."""

from __future__ import annotations

import re
import tomllib
from dataclasses import dataclass
from typing import Any, Iterable

from . import messages as m

WORDS = re.compile(r"[^\W_]+(?:[-'][^\W_]+)*")
"""What counts as a word of an utterance."""


def fnv1a(data: bytes, value: int = 0xCBF29CE484222325) -> int:
    """64-bit FNV-1a."""
    for byte in data:
        value = ((value ^ byte) * 0x100000001B3) & 0xFFFFFFFFFFFFFFFF
    return value


@dataclass(frozen=True)
class Scene:
    """Objects, attributes and words of a scene file."""

    objects: list[str]
    """Names of the objects; messages give an object as its place in this list."""
    attributes: dict[str, dict[str, str]]
    """Value of each attribute by object; an object may lack one."""
    values: dict[str, list[str]]
    """Values of each attribute; messages give both as their places."""
    words: list[str]
    """The words that describe objects: all values, in order of first appearance. Messages give a word as its
    place in this list."""
    synonyms: dict[str, list[str]]
    """Other words for a word."""
    key: int
    """Key of the scene, which messages about it carry."""

    @classmethod
    def parse(cls, text: str) -> Scene:
        """Reads a scene file's text."""
        scene = tomllib.loads(text)
        values, synonyms = {}, {}
        for attribute in scene["attributes"]:
            listed = [value if isinstance(value, dict) else {"name": value} for value in attribute["values"]]
            values[attribute["name"]] = [value["name"] for value in listed]
            for value in listed:
                synonyms.setdefault(value["name"], []).extend(value.get("synonyms", []))
        objects = scene["objects"]
        words = dict.fromkeys(word for listed in values.values() for word in listed)
        return cls([it["name"] for it in objects], {it["name"]: it.get("attributes", {}) for it in objects},
                   values, list(words), synonyms, _key(values, objects))

    def word(self, name: str) -> int:
        """The number of a word. Raises `ValueError` for one that the scene does not have."""
        try:
            return self.words.index(name)
        except ValueError:
            raise ValueError(f"expected a word of the scene ({', '.join(self.words)}), found {name!r}") from None

    def question(self, question: m.WireQuestion | m.Question) -> str:
        """A question in a few words, such as `colour white?`; empty for none."""
        match question:
            case m.WireQuestion(kind=1):
                return f"{self.objects[question.object]}?"
            case m.WireQuestion(kind=4):
                packed = question.object | question.value << 16
                return self._options(question.attribute, [byte - 1 for byte in packed.to_bytes(4, "little") if byte])
            case m.WireQuestion(kind=2 | 3):
                name, listed = list(self.values.items())[question.attribute]
                return f"{name} {listed[question.value]}?" if question.kind == 2 else f"which {name}?"
            case m.QuestionPoint(number):
                return f"{self.objects[number]}?"
            case m.QuestionAttribute(attribute, value):
                name, listed = list(self.values.items())[attribute]
                return f"{name} {listed[value]}?"
            case m.QuestionWhich(attribute):
                return f"which {list(self.values)[attribute]}?"
            case m.QuestionChoice(attribute, options):
                return self._options(attribute, options)
        return ""

    def _options(self, attribute: int, options: Iterable[int]) -> str:
        listed = list(self.values.values())[attribute]
        return " or ".join(listed[value] for value in options) + "?"

    def spot(self, text: str, also: Iterable[tuple[str, str]] = ()) -> list[tuple[str, int]]:
        """The scene's words in a text, each with the place of its blank-separated word. `also` holds more
        phrases with the words that they stand for."""
        phrases = [(WORDS.findall(word.lower()), word) for word in self.words]
        phrases += [(WORDS.findall(phrase.lower()), word) for phrase, word in also]
        phrases.sort(key=lambda phrase: -len(phrase[0]))
        found = list(WORDS.finditer(text.lower()))
        said = [match.group() for match in found]
        places = [len(text[:match.start()].split(" ")) - 1 for match in found]
        spotted, at = [], 0
        while at < len(said):
            fits = (it for it in phrases if it[0] and said[at:at + len(it[0])] == it[0])
            phrase, word = next(fits, ([""], None))
            if word is not None:
                spotted.append((word, places[at]))
            at += len(phrase)
        return spotted


def _key(values: dict[str, list[str]], objects: list[dict[str, Any]]) -> int:
    """Hash of attributes, values and objects in order, every text after its length and every list after its
    count."""
    def count(number: int) -> bytes:
        return number.to_bytes(8, "little")

    def text(it: str) -> bytes:
        return count(len(it.encode())) + it.encode()

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
