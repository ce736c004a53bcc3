"""Words that mean a stop and nothing else, and the stop of several robots."""

from __future__ import annotations

import asyncio
import logging
import re

from .const import STOP, STOP_THE_ROBOT
from .link import WhichoneEntry

_LOGGER = logging.getLogger(__name__)

# Home Assistant's sentences as expressions: "[the] " may be left out.
_SENTENCES = "|".join(sentence.replace("[", "(?:").replace("] ", " )?") for sentence in [*STOP, *STOP_THE_ROBOT])
_STOPS = re.compile(_SENTENCES)
# Words beside a stop that change nothing.
_BESIDE = frozenset({"please", "now", "bitte", "jetzt", "sofort"})


def is_stop(text: str) -> bool:
    """Return whether the words mean a stop and nothing else. The robot understands more of them by itself."""
    words: list[str] = []
    for word in re.findall(r"[^\W_]+", text.casefold()):
        if word not in _BESIDE and words[-1:] != [word]:
            words.append(word)
    return _STOPS.fullmatch(" ".join(words)) is not None


async def stop(entries: list[WhichoneEntry]) -> list[WhichoneEntry]:
    """Stop robots at the same time, wait for all of them, and return those that have not confirmed."""
    stops = [entry.runtime_data.robot.stop() for entry in entries]
    failed = []
    for entry, result in zip(entries, await asyncio.gather(*stops, return_exceptions=True), strict=True):
        if isinstance(result, BaseException):
            _LOGGER.error("the stop of %s is not confirmed: %s", entry.title, result)
            failed.append(entry)
    return failed
