"""Sentences through Home Assistant's whole pipeline, in which its own intents go first."""

import asyncio

import pytest
from homeassistant.components import conversation
from homeassistant.core import Context

from conftest import connected, until
from custom_components.whichone import link
from fake_robot import ID, TOKEN, reply_of
from talk import Pipeline, entity


async def tell(hass, text, language="en"):
    """Say something to Home Assistant's own agent, and return what it answers."""
    said = await conversation.async_converse(
        hass, text, None, Context(), language, agent_id="conversation.home_assistant"
    )
    return said.response.speech.get("plain", {}).get("speech")


async def ask(hass, *robots):
    """Have robots ask something."""
    for robot in robots:
        await robot.publish("question")
    entries = hass.config_entries.async_entries("whichone")
    await until(lambda: sum(entry.runtime_data.is_engaged for entry in entries) == len(robots))
    await hass.async_block_till_done()


async def test_answer_goes_to_the_robot_alone(core, hass_ws_client, fake, entry):
    pipeline = await Pipeline.open(core, hass_ws_client)
    fake.script = ["question", "ended"]
    assert (await pipeline("get me the bowl"))["open"]
    assert await pipeline("never mind") == {"text": reply_of("ended")["text"], "open": False}
    assert [words["text"] for words in fake.said] == ["get me the bowl", "never mind"]


async def test_never_mind_and_stop_reach_a_busy_robot_and_no_other(core, hass_ws_client, fake, entry):
    pipeline = await Pipeline.open(core, hass_ws_client)
    assert not (await pipeline("never mind", wakes=True))["text"]
    assert fake.said == []
    await fake.publish("question")
    await until(lambda: core.states.get(entity(core, "activity")).state == "asking")
    await core.async_block_till_done()
    fake.script = ["ended"]
    assert await pipeline("never mind", wakes=True) == {"text": "All right.", "open": False}
    assert [words["text"] for words in fake.said] == ["never mind"]
    assert (await pipeline("Stop!", wakes=True))["text"] == "I have stopped."
    assert fake.asked.count("motion/stop") == 1
    await fake.publish("ended")
    await until(lambda: not entry.runtime_data.is_busy)
    await core.async_block_till_done()
    assert not (await pipeline("never mind", wakes=True))["text"]
    assert [words["text"] for words in fake.said] == ["never mind"]
    assert fake.asked.count("motion/stop") == 1


@pytest.mark.parametrize(
    ("language", "text", "answer"),
    [("en", "Stop the robot!", "I have stopped."), ("de", "Stopp den Roboter!", "Ich habe angehalten.")],
)
async def test_robot_is_stopped_by_name_in_every_state_and_by_every_agent(core, fake, entry, language, text, answer):
    assert await tell(core, text, language) == answer
    assert fake.asked.count("motion/stop") == 1


async def test_stop_that_is_not_confirmed_is_no_stop(core, hass_ws_client, fake, entry):
    pipeline = await Pipeline.open(core, hass_ws_client)
    fake.answers["motion/stop"] = "unavailable"
    assert "has not confirmed the stop" in (await pipeline("stop the robot"))["text"]


async def test_sentences_end_with_the_entry(core, hass_ws_client, fake, entry):
    pipeline = await Pipeline.open(core, hass_ws_client)
    await fake.publish("question")
    await until(lambda: entry.runtime_data.is_busy)
    await core.async_block_till_done()
    assert await core.config_entries.async_unload(entry.entry_id)
    fake.asked.clear()
    said = await conversation.async_converse(
        core, "stop the robot", None, Context(), "en", agent_id="conversation.home_assistant"
    )
    assert said.response.error_code is not None
    assert "motion/stop" not in fake.asked
    assert pipeline


@pytest.mark.parametrize(
    ("language", "text", "answer"),
    [
        ("en", "stop the robot", "Not all robots have confirmed the stop! Use the emergency stop of: garage."),
        (
            "de",
            "Stopp den Roboter",
            "Nicht alle Roboter haben den Stopp bestätigt! Benutze den Not-Halt von: garage.",
        ),
    ],
)
async def test_two_robots_have_stopped_only_if_both_confirm(core, fake, entry, second, language, text, answer):
    second.stop_takes_s = 0.3
    assert await tell(core, "stop the robot") == "I have stopped."
    assert [robot.asked.count("motion/stop") for robot in (fake, second)] == [1, 1]
    second.answers["motion/stop"] = "unavailable"
    assert await tell(core, text, language) == answer
    assert [robot.asked.count("motion/stop") for robot in (fake, second)] == [2, 2]


async def test_stop_reaches_both_robots_while_one_is_busy(core, fake, entry, second):
    second.stop_takes_s = 0.3
    await ask(core, second)
    assert await tell(core, "stop") == "I have stopped."
    assert [robot.asked.count("motion/stop") for robot in (fake, second)] == [1, 1]


@pytest.mark.parametrize(
    ("first", "other", "answer"),
    [
        ("ended", "ended", "All right."),
        ("ended", "busy", "All right."),
        ("busy", "ended", "All right."),
        ("ended", "right", "All right. I cannot withdraw the request from: garage."),
        ("busy", "right", "I cannot withdraw the request from: garage."),
        ("busy", "busy", "I am talking with someone else. Say stop to stop me."),
    ],
)
async def test_never_mind_reaches_each_robot_that_is_busy(core, fake, entry, second, first, other, answer):
    await ask(core, fake, second)
    fake.script, second.script = [first], [other]
    assert await tell(core, "never mind") == answer
    assert [len(robot.said) for robot in (fake, second)] == [1, 1]


async def test_never_mind_reaches_no_idle_robot(core, fake, entry, second):
    await ask(core, second)
    second.script = ["ended"]
    assert await tell(core, "never mind") == "All right."
    assert [len(robot.said) for robot in (fake, second)] == [0, 1]


async def test_sentences_go_on_with_the_robot_that_is_left(core, fake, entry, second):
    await ask(core, second)
    other = core.config_entries.async_entry_for_domain_unique_id("whichone", "another")
    assert await core.config_entries.async_unload(other.entry_id)
    assert await tell(core, "stop the robot") == "I have stopped."
    await tell(core, "stop")
    await tell(core, "never mind")
    assert [robot.asked.count("motion/stop") for robot in (fake, second)] == [1, 0]
    assert [len(robot.said) for robot in (fake, second)] == [0, 0]
    assert await core.config_entries.async_setup(other.entry_id)
    assert await tell(core, "stop the robot") == "I have stopped."
    assert [robot.asked.count("motion/stop") for robot in (fake, second)] == [2, 1]


async def test_stop_reaches_an_arm_that_moves_home(core, fake, entry, monkeypatch):
    monkeypatch.setattr(link, "ARM_PAUSE_S", 0.05)
    fake.arm_moves = True
    await fake.publish("question", "ended")
    await until(lambda: entry.runtime_data.state.get("ended"))
    await core.async_block_till_done()
    assert entry.runtime_data.state["state"] == "idle"
    await asyncio.sleep(0.5)
    assert await tell(core, "stop") == "I have stopped."
    assert fake.asked.count("motion/stop") == 1
    # There is nothing to withdraw.
    await tell(core, "never mind")
    assert fake.said == []
    fake.arm_moves = False
    await until(lambda: not entry.runtime_data.is_busy)
    await core.async_block_till_done()
    await tell(core, "stop")
    assert fake.asked.count("motion/stop") == 1


async def test_stop_reaches_an_arm_that_moves_since_before_the_setup(core, fake, monkeypatch):
    monkeypatch.setattr(link, "ARM_PAUSE_S", 0.05)
    fake.arm_moves = True
    entry = await connected(core, fake.url, TOKEN, ID)
    assert await tell(core, "stop") == "I have stopped."
    await until(lambda: fake.resumed_after)
    # An outage does not end that, and the arm is looked at again afterwards.
    await fake.end()
    await until(lambda: not entry.runtime_data.is_connected)
    fake.arm_moves = False
    assert entry.runtime_data.is_busy
    await fake.start()
    await until(lambda: not entry.runtime_data.is_busy, 30)
    await core.config_entries.async_unload(entry.entry_id)
