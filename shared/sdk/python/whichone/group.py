"""The folder of a group, and what it says about the group."""

from __future__ import annotations

import json
import os
import tomllib
from pathlib import Path
from typing import Any

from .scene import Scene


class GroupNotRunning(ConnectionError):
    """No group of that name runs."""


class Group:
    """A group of processes, by its name and the folder of all groups."""

    def __init__(self, name: str | None = None, home: str | os.PathLike[str] | None = None) -> None:
        """`name` is `$WHICHONE_GROUP` or `whichone` where it is left out, `home` is `$WHICHONE_HOME`,
        `$XDG_STATE_HOME/whichone` or `~/.local/state/whichone`."""
        environment = os.environ.get
        self.name = name or environment("WHICHONE_GROUP") or "whichone"
        if home is None:
            home = environment("WHICHONE_HOME")
        if not home:
            state = environment("XDG_STATE_HOME") or Path.home() / ".local/state"
            home = Path(state) / "whichone"
        self.folder = Path(os.path.abspath(home)) / self.name

    @property
    def run(self) -> Path:
        """Folder with sockets and settings; it exists while the group runs."""
        return self.folder / "run"

    def not_running(self) -> GroupNotRunning:
        """The error that says so, with its fix."""
        return GroupNotRunning(f"group {self.name} is not running ({self.run}: no such folder, or incomplete); "
                               f"help: start it with `whichone up --group {self.name}`")

    def shm_name(self) -> str:
        """Name of the group's shared memory."""
        try:
            return (self.run / "shm").read_text(encoding="ascii")
        except OSError:
            raise self.not_running() from None

    def epoch(self) -> int:
        """Number of the life of the group's journals; messages of another one do not count."""
        path = self.folder / "epoch"
        try:
            return int(json.loads(path.read_text(encoding="utf-8").splitlines()[0])["epoch"])
        except FileNotFoundError:
            raise self.not_running() from None
        except (ValueError, KeyError, IndexError, TypeError) as error:
            raise ValueError(f"{path}: expected the set of journals, found damage ({error}); "
                             "help: see `whichone status`") from None

    def settings(self) -> dict[str, Any]:
        """The settings in force, by section and key."""
        try:
            with open(self.run / "settings.toml", "rb") as file:
                return tomllib.load(file)
        except FileNotFoundError:
            raise self.not_running() from None

    def scene(self) -> Scene:
        """The scene in force: objects, attributes and words."""
        return Scene.parse(self.settings()["scene"]["text"])
