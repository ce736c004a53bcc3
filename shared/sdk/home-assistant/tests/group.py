"""A real group, and people who want an object."""

from __future__ import annotations

import asyncio
import json
import os
import signal
import socket
import subprocess
import time
import tomllib
from pathlib import Path
from typing import Any

import aiohttp

ROOT = Path(__file__).resolve().parents[4]
# The program; a test without it is skipped.
WHICHONE = os.environ.get("WHICHONE", "")
SCENE = tomllib.loads((ROOT / "config/scenes/bowls.toml").read_text())
OBJECTS = {one["name"]: one["attributes"] for one in SCENE["objects"]}
SPOKEN = {
    (attribute["name"], value["name"]): value.get("spoken", value["name"])
    for attribute in SCENE["attributes"]
    for value in (one if isinstance(one, dict) else {"name": one} for one in attribute["values"])
}

# Milliseconds that dialogues took, by what was done.
MEASURED: dict[str, list[float]] = {"answer": [], "stop": []}


def free_port() -> int:
    """Return a port that nobody listens on."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


class Group:
    """A process group of its own, with an arm that takes some seconds for a fetch."""

    def __init__(self, home: Path) -> None:
        """Choose where it lives and listens."""
        self.url = f"http://127.0.0.1:{free_port()}"
        self._environment = os.environ | {"WHICHONE_HOME": str(home), "WHICHONE_GROUP": f"ha{os.getpid()}"}
        self.token = ""

    def run(self, *words: str) -> str:
        """Run a verb of the command line to its end."""
        ended = subprocess.run(
            [WHICHONE, *words],
            env=self._environment,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=120,
        )
        assert ended.returncode == 0, (words, ended)
        return ended.stdout

    def up(self) -> None:
        """Start it, until it is ready."""
        settings = [f"console.listen={self.url.removeprefix('http://')}", "arm.time_scale=3", "speech.recogniser=none"]
        options = [word for setting in settings for word in ("--set", setting)]
        config = str(ROOT / "config")
        self.run("up", "--detach", "--wait", "ready", "--config", config, "--profile", "ci", *options)
        if not self.token:
            made = self.run("token", "add", "home-assistant", "--may", "see,talk,stop,resume", "--json")
            self.token = json.loads(made)["token"]

    def down(self) -> None:
        """Stop it."""
        self.run("down")

    def kill(self, *services: str) -> None:
        """Kill services; the supervisor starts them again."""
        for service in json.loads(self.run("status", "--json"))["services"]:
            if service["name"] in services:
                os.kill(service["pid"], signal.SIGKILL)

    async def ask(self, method: str, path: str) -> dict[str, Any]:
        """Ask the robot, beside Home Assistant."""
        headers = {"Authorization": f"Bearer {self.token}"}
        async with (
            aiohttp.ClientSession(headers=headers) as session,
            session.request(method, f"{self.url}/api/v1/{path}") as response,
        ):
            return await response.json(content_type=None)

    async def state(self) -> dict[str, Any]:
        """Return the robot's state."""
        return await self.ask("GET", "state")

    async def until(self, fact: Any, seconds: float = 60.0) -> dict[str, Any]:
        """Wait for a state, through restarts of the console."""
        began, state = time.monotonic(), {}
        while time.monotonic() - began < seconds:
            try:
                state = await self.state()
                if "state" in state and fact(state):
                    return state
            except (aiohttp.ClientError, ValueError):
                pass
            await asyncio.sleep(0.05)
        raise AssertionError(f"not so after {seconds} s: {state}")

    async def truth(self, wanted: str) -> str:
        """Return the true answer to the open question of a person who wants an object."""
        question, wants = (await self.state())["question"], OBJECTS[wanted]
        match question["type"]:
            case "choice" | "which":
                attribute = question["attribute"]
                return SPOKEN[attribute, wants[attribute]]
            case "attr":
                return "yes" if wants[question["attribute"]] == question["value"] else "no"
            case "point":
                return "yes" if question["object"] == wanted else "no"
            case _:
                return "yes"
