"""Home Assistant's core, its pipeline and a real group: each dialogue ends with the right object, or with none."""

import asyncio
import time

import pytest
import pytest_socket

from conftest import connected, until
from group import MEASURED, WHICHONE, Group
from talk import Pipeline, entity

pytestmark = pytest.mark.skipif(not WHICHONE, reason="WHICHONE does not name the program")


@pytest.fixture(scope="module")
def group(tmp_path_factory):
    """Return a running group."""
    # Earlier than the sockets of each test.
    pytest_socket.enable_socket()
    group = Group(tmp_path_factory.mktemp("wo"))
    group.up()
    yield group
    group.down()


@pytest.fixture
async def robot(core, group):
    """Return the entry of a robot that is idle."""
    state = await group.until(lambda state: True)
    if state["state"] == "stopped":
        await group.ask("POST", "motion/resume")
    await group.until(lambda state: state["state"] == "idle" and not state["interaction"])
    entry = await connected(core, group.url, group.token, (await group.ask("GET", "info"))["id"])
    await until(lambda: entry.runtime_data.is_connected)
    yield entry
    await core.config_entries.async_unload(entry.entry_id)


@pytest.fixture
async def talk(core, hass_ws_client, robot):
    """Return a pipeline that ends at the robot."""
    return await Pipeline.open(core, hass_ws_client)


async def timed(what, action):
    """Do something, and measure how long it takes."""
    began = time.monotonic()
    result = await action
    MEASURED[what].append(1000 * (time.monotonic() - began))
    return result


async def converse(group, talk, said, wanted, before=0):
    """Answer the robot's questions truthfully until it waits for nothing; return how the request ended."""
    for _ in range(8):
        if not said["open"]:
            break
        said = await timed("answer", talk(await group.truth(wanted)))
    assert said["text"].startswith("I will get"), said
    return await ended(group, before)


async def ended(group, before):
    """Return how the request after number `before` has ended."""
    state = await group.until(lambda state: (state["ended"] or {"interaction": 0})["interaction"] > before)
    return state["ended"]


async def latest(group):
    """Return the number of the request that ended last."""
    return ((await group.state())["ended"] or {"interaction": 0})["interaction"]


async def fetching(core, group):
    """Wait until the arm moves, and Home Assistant knows."""
    await group.until(lambda state: state["arm"]["moving"])
    await until(lambda: core.states.get(entity(core, "activity")).state == "fetching")
    await core.async_block_till_done()


async def press(core, key):
    """Press a button."""
    await core.services.async_call("button", "press", {"entity_id": entity(core, key)}, blocking=True)


async def test_01_bowl_out_of_six(core, group, talk):
    before = await latest(group)
    end = await converse(group, talk, await timed("answer", talk("get me the bowl")), "white2", before)
    assert (end["object"], end["outcome"]) == ("white2", "delivered")
    await until(lambda: core.states.get(entity(core, "dialogue")).attributes.get("object") == "white2")


async def test_02_named_bowl_needs_no_question(group, talk):
    before = await latest(group)
    said = await talk("get me the clear bowl")
    assert not said["open"]
    assert (await converse(group, talk, said, "clear", before))["object"] == "clear"


async def test_03_denial_during_the_fetch(core, group, talk):
    before = await latest(group)
    await talk("get me the clear bowl")
    await fetching(core, group)
    said = await talk("no, not that one", wakes=True)
    assert said["open"], said
    end = await converse(group, talk, said, "metal2", before)
    assert (end["object"], end["outcome"]) == ("metal2", "delivered")


async def test_04_never_mind_to_a_question(group, talk):
    before = await latest(group)
    assert (await talk("get me the bowl"))["open"]
    assert not (await talk("never mind"))["open"]
    end = await ended(group, before)
    assert (end["object"], end["outcome"]) == (None, "cancelled")


async def test_05_never_mind_during_the_fetch(core, group, talk):
    before = await latest(group)
    await talk("get me the clear bowl")
    await fetching(core, group)
    said = await talk("never mind", wakes=True)
    assert said["text"].startswith("All right")
    assert not said["open"]
    assert (await ended(group, before))["outcome"] == "cancelled"
    # The arm comes back without having delivered anything.
    state = await group.until(lambda state: state["state"] == "idle" and not state["arm"]["moving"])
    assert state["ended"]["outcome"] == "cancelled"


async def test_06_stop_during_the_fetch_and_resume(core, group, talk):
    before = await latest(group)
    await talk("get me the clear bowl")
    await fetching(core, group)
    said = await timed("stop", talk("stop", wakes=True))
    arm = (await group.state())["arm"]
    assert said == {"text": "I have stopped.", "open": False}
    assert arm["stopped"]
    assert not arm["moving"]
    assert await latest(group) == before
    await asyncio.sleep(2.1)  # no release counts within 2 s of a stop
    await press(core, "resume")
    assert (await ended(group, before))["object"] == "clear"


async def test_07_stop_to_a_question_and_by_the_button(core, group, talk):
    before = await latest(group)
    first = await talk("get me the bowl")
    assert first["open"]
    assert not (await timed("stop", talk("stop")))["open"]
    assert (await group.state())["arm"]["stopped"]
    for _ in range(10):
        await timed("stop", press(core, "stop"))
    await asyncio.sleep(2.1)
    await press(core, "resume")
    state = await group.until(lambda state: state["state"] != "stopped")
    said = {"text": state["text"], "open": state["expects_answer"]}
    assert (await converse(group, talk, said, "white3", before))["object"] == "white3"


async def test_08_services_killed_between_question_and_answer(group, talk):
    before = await latest(group)
    assert (await talk("get me the bowl"))["open"]
    answer = await group.truth("white2")
    group.kill("policy", "speech", "grounding")
    said = await talk(answer)
    assert (await converse(group, talk, said, "white2", before))["object"] == "white2"


async def test_09_group_down_and_up_between_question_and_answer(core, group, talk):
    before = await latest(group)
    said = await talk("get me the bowl")
    answer = await group.truth(wanted="white2")
    await asyncio.to_thread(group.down)
    heard = core.async_create_task(talk(answer))
    await until(lambda: core.states.get(entity(core, "activity")).state == "unavailable", 20)
    await asyncio.to_thread(group.up)
    assert (await converse(group, talk, await heard, "white2", before))["object"] == "white2"
    assert said["open"]


async def test_10_two_users(core, group, hass_ws_client, hass_read_only_access_token, talk):
    before = await latest(group)
    bob = Pipeline(await hass_ws_client(core, hass_read_only_access_token), talk.name)
    said = await talk("get me the bowl")
    refused = await bob("get me the clear bowl")
    assert refused == {"text": "I am talking with someone else. Say stop to stop me.", "open": False}
    assert (await timed("stop", bob("stop")))["text"] == "I have stopped."
    assert (await group.state())["arm"]["stopped"]
    await asyncio.sleep(2.1)
    await press(core, "resume")
    await group.until(lambda state: state["state"] != "stopped")
    assert (await converse(group, talk, said, "metal", before))["object"] == "metal"


async def test_11_home_assistant_restarts_between_question_and_answer(core, group, talk, robot):
    before = await latest(group)
    said = await talk("get me the bowl")
    assert await core.config_entries.async_reload(robot.entry_id)
    await until(lambda: robot.runtime_data.is_connected)
    assert (await converse(group, talk, said, "white2", before))["object"] == "white2"


async def test_12_stop_while_the_console_restarts(core, group, talk):
    before = await latest(group)
    await talk("get me the clear bowl")
    await fetching(core, group)
    group.kill("console")
    await press(core, "stop")
    state = await group.until(lambda state: state["arm"] is not None)
    assert state["arm"]["stopped"]
    await asyncio.sleep(2.1)
    await group.ask("POST", "motion/resume")
    assert (await ended(group, before))["object"] == "clear"


async def test_13_journals_have_every_utterance_once(group):
    assert "applied once" in group.run("journal", "--verify")
