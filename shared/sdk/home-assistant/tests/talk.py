"""Sentences to a robot, straight and through the pipeline that satellites use."""

from homeassistant.components import conversation
from homeassistant.core import Context
from homeassistant.helpers import entity_registry as er
from homeassistant.setup import async_setup_component


def entity(hass, key):
    """Return the name of an entity of the robot."""
    entities = er.async_get(hass).entities.values()
    return next(one.entity_id for one in entities if one.platform == "whichone" and one.unique_id.endswith(f"_{key}"))


async def say(hass, text, conversation_id=None, device=None, context=None):
    """Say something to the agent, without a pipeline."""
    agent = entity(hass, "robot")
    return await conversation.async_converse(
        hass, text, conversation_id, context or Context(), "en", agent_id=agent, device_id=device
    )


def spoken(result):
    """Return what is said."""
    return result.response.speech["plain"]["speech"]


class Pipeline:
    """The whole pipeline from text to reply; local intents go first."""

    def __init__(self, socket, name):
        """Run a pipeline over a web socket of Home Assistant."""
        self._socket, self.name, self.conversation = socket, name, None

    @classmethod
    async def open(cls, hass, hass_ws_client):
        """Make a pipeline that ends at the robot."""
        assert await async_setup_component(hass, "assist_pipeline", {})
        await hass.async_block_till_done()
        socket = await hass_ws_client(hass)
        settings = dict.fromkeys(
            [
                "stt_engine",
                "stt_language",
                "tts_engine",
                "tts_language",
                "tts_voice",
                "wake_word_entity",
                "wake_word_id",
            ]
        )
        settings |= {
            "type": "assist_pipeline/pipeline/create",
            "name": "robot",
            "language": "en",
            "conversation_engine": entity(hass, "robot"),
            "conversation_language": "en",
            "prefer_local_intents": True,
        }
        await socket.send_json_auto_id(settings)
        made = await socket.receive_json()
        assert made["success"], made
        return cls(socket, made["result"]["id"])

    async def __call__(self, text, *, wakes=False):
        """Say something, after the wake word or into the open microphone."""
        run = {"type": "assist_pipeline/run", "start_stage": "intent", "end_stage": "intent", "input": {"text": text}}
        if self.conversation and not wakes:
            run["conversation_id"] = self.conversation
        await self._socket.send_json_auto_id(run | {"pipeline": self.name})
        out = {}
        while True:
            message = await self._socket.receive_json(timeout=60)
            if message["type"] == "result":
                assert message["success"], message
                continue
            event = message["event"]
            if event["type"] == "error":
                raise AssertionError(event)
            if event["type"] == "intent-end":
                out = event["data"]
            if event["type"] == "run-end":
                break
        result = out["intent_output"]
        self.conversation = result["conversation_id"]
        speech = result["response"]["speech"].get("plain", {}).get("speech")
        return {"text": speech, "open": result["continue_conversation"]}
