"""The robot's own question, heard back by the satellite that has just said it.

Satellites may open the microphone before their reply has ended.
"""

from __future__ import annotations

import re

from .const import ECHO_S

# A question without one of these, or with fewer words, may be repeated as the answer: "The red one?"
_VERBS = frozenset(
    {"is", "are", "do", "does", "did", "can", "could", "shall", "should", "will", "would", "have", "has"}
    | {"what", "which", "where", "who", "how"}
)
_WORDS_MIN = 3


def is_echo(heard: str, line: str, age_s: float) -> bool:
    """Return whether the words are a line of that age, or some of its sentences in a row, word for word."""
    words = _words(heard)
    if age_s > ECHO_S or len(words) < _WORDS_MIN or _VERBS.isdisjoint(words):
        return False
    sentences = [_words(sentence) for sentence in re.split("[.!?]", line)]
    ends = range(1, len(sentences) + 1)
    runs = (sentences[start:end] for end in ends for start in range(end))
    return any(words == [word for sentence in run for word in sentence] for run in runs)


def _words(text: str) -> list[str]:
    return re.findall(r"[^\W_]+", text.casefold())
