"""A Home Assistant core with the integration, and robots to talk with."""

import asyncio

import pytest
import pytest_socket
from homeassistant.setup import async_setup_component
from pytest_homeassistant_custom_component.common import MockConfigEntry

# Before the core brings a folder of that name of its own.
import custom_components  # noqa: F401
from fake_robot import ID, TOKEN, Fake
from group import MEASURED


def pytest_runtest_setup():
    """Let tests reach robots of this machine."""
    pytest_socket.enable_socket()
    pytest_socket.socket_allow_hosts(["127.0.0.1", "localhost"], allow_unix_socket=True)


def pytest_terminal_summary(terminalreporter):
    """Print what was measured with a real group."""
    for what, measured in MEASURED.items():
        if ordered := sorted(measured):
            middle, longest = ordered[len(ordered) // 2], ordered[-1]
            line = f"{what}: {len(ordered)} times, median {middle:.0f} ms, longest {longest:.0f} ms"
            terminalreporter.write_line(line)


@pytest.fixture(autouse=True)
def whichone(enable_custom_integrations, socket_enabled):
    """Have the core load integrations from this folder."""
    return


@pytest.fixture
async def core(hass):
    """Return a core that understands sentences."""
    for component in ("homeassistant", "conversation"):
        assert await async_setup_component(hass, component, {})
    return hass


@pytest.fixture
async def fake(core):
    """Return a console that is recorded."""
    robot = Fake()
    await robot.start()
    yield robot
    await robot.end()


async def connected(hass, url, token, unique_id, title="robot"):
    """Set up a robot and wait until its events come."""
    data = {"url": url, "token": token}
    entry = MockConfigEntry(domain="whichone", unique_id=unique_id, title=title, data=data)
    entry.add_to_hass(hass)
    assert await hass.config_entries.async_setup(entry.entry_id)
    await hass.async_block_till_done()
    return entry


@pytest.fixture
async def entry(core, fake):
    """Return the entry of a recorded robot."""
    entry = await connected(core, fake.url, TOKEN, ID)
    await until(lambda: fake.resumed_after)
    yield entry
    await core.config_entries.async_unload(entry.entry_id)


@pytest.fixture
async def second(core, entry):
    """Return another recorded robot, which is set up as well."""
    robot = Fake()
    robot.info = {"id": "another", "name": "garage"}
    await robot.start()
    second = await connected(core, robot.url, TOKEN, "another", "garage")
    await until(lambda: robot.resumed_after)
    yield robot
    await core.config_entries.async_unload(second.entry_id)
    await robot.end()


async def until(fact, seconds=10.0):
    """Wait for a fact."""
    for _ in range(int(seconds / 0.02)):
        if fact():
            return
        await asyncio.sleep(0.02)
    raise AssertionError(f"not so after {seconds} s: {fact}")
