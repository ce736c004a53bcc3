"""Sentences through Home Assistant's whole pipeline, in which its own intents go first."""

import pytest
from homeassistant.components import conversation
from homeassistant.core import Context

from conftest import until
from fake_robot import reply_of
from talk import Pipeline, entity


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
    said = await conversation.async_converse(
        core, text, None, Context(), language, agent_id="conversation.home_assistant"
    )
    assert said.response.speech["plain"]["speech"] == answer
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
