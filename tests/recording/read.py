#!/usr/bin/env python3
"""Reads recordings with the libraries of others, and prints what they hold as JSON.

Every message is decoded: CDR by mcap-ros2-support, JSON against its own schema by jsonschema, and Foxglove's
messages against the schemas of foxglove-sdk. An error of any of them ends the program.
"""

import json
import sys
from datetime import datetime, timezone

import foxglove.messages
import jsonschema
from google.protobuf import descriptor_pb2, descriptor_pool, json_format, message_factory
from mcap.decoder import DecoderFactory
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory as ProtobufDecoderFactory
from mcap_ros2.decoder import DecoderFactory as Ros2DecoderFactory

POOL = descriptor_pool.DescriptorPool()
KNOWN = {}


def foxglove_type(name):
    """The protobuf type of a schema that foxglove-sdk brings."""
    if name not in KNOWN:
        schema = getattr(foxglove.messages, name.removeprefix("foxglove.")).get_schema()
        files = descriptor_pb2.FileDescriptorSet.FromString(schema.data)
        for file in files.file:
            try:
                POOL.FindFileByName(file.name)
            except KeyError:
                POOL.Add(file)
        KNOWN[name] = message_factory.GetMessageClass(POOL.FindMessageTypeByName(name))
    return KNOWN[name]


def in_protobuf(value, key=None):
    """A message in Foxglove's JSON as protobuf's JSON has it: moments differ."""
    if isinstance(value, dict) and value.keys() == {"sec", "nsec"}:
        if key == "lifetime":
            return f"{value['sec']}.{value['nsec']:09}s"
        second = datetime.fromtimestamp(value["sec"], timezone.utc).strftime("%Y-%m-%dT%H:%M:%S")
        return f"{second}.{value['nsec']:09}Z"
    if isinstance(value, dict):
        return {key: in_protobuf(item, key) for key, item in value.items()}
    if isinstance(value, list):
        return [in_protobuf(item) for item in value]
    return value


class JsonDecoderFactory(DecoderFactory):
    """Decodes JSON, and validates it against its schema."""

    def __init__(self):
        self.validators = {}

    def decoder_for(self, message_encoding, schema):
        if message_encoding != "json":
            return None
        if schema.id not in self.validators:
            content = json.loads(schema.data)
            jsonschema.Draft202012Validator.check_schema(content)
            self.validators[schema.id] = jsonschema.Draft202012Validator(content)
        validator = self.validators[schema.id]

        def decode(data):
            message = json.loads(data)
            validator.validate(message)
            if schema.name.startswith("foxglove."):
                json_format.ParseDict(in_protobuf(message), foxglove_type(schema.name)())
            return message

        return decode


def plain(value):
    """A decoded message as JSON; texts of fixed length as text."""
    if hasattr(value, "__slots__"):
        fields = {name: getattr(value, name) for name in value.__slots__}
        if fields.keys() == {"len", "bytes"}:
            return bytes(fields["bytes"][: fields["len"]]).decode()
        return {name: plain(field) for name, field in fields.items()}
    if isinstance(value, (list, tuple)):
        return [plain(item) for item in value]
    if isinstance(value, bytes):
        return list(value)
    return value


# Topics whose messages are printed.
SHOWN = {
    "/speech/receipt": ("seq", "status", "note"),
    "/policy/act": ("act", "interaction", "kind", "prompt", "object", "text", "decided_ns"),
    "/arm/status": ("interaction", "attempt", "object", "phase", "outcome"),
    "/policy/view": ("interaction", "applied", "belief", "last"),
    "/dialogue": ("name", "message"),
}


def read(path, found):
    """Adds what is in a file."""
    # Foxglove's readers need an index; a summary with statistics is one.
    with open(path, "rb") as stream:
        factories = [Ros2DecoderFactory(), ProtobufDecoderFactory(), JsonDecoderFactory()]
        reader = make_reader(stream, validate_crcs=True, decoder_factories=factories)
        statistics = reader.get_summary().statistics
        count = 0
        for schema, channel, message, decoded in reader.iter_decoded_messages():
            count += 1
            topic = found["topics"].setdefault(
                channel.topic,
                {"count": 0, "lost": 0, "schema": schema.name, "encoding": channel.message_encoding, "last": 0},
            )
            topic["count"] += 1
            span = found["span"]
            span[0] = min(span[0] or message.log_time, message.log_time)
            span[1] = max(span[1], message.log_time)
            if channel.topic in SHOWN:
                whole = plain(decoded)
                fields = {name: whole[name] for name in SHOWN[channel.topic]}
                messages = found["messages"].setdefault(channel.topic, [])
                if not messages or messages[-1] != fields:
                    messages.append(fields)
        assert count == statistics.message_count, (count, statistics.message_count)
        # As they were written: lines of several logs come late.
        for _, channel, message in reader.iter_messages(log_time_order=False):
            topic = found["topics"][channel.topic]
            # A smaller number is of the writer's next start.
            if topic["last"] and message.sequence > topic["last"]:
                topic["lost"] += message.sequence - topic["last"] - 1
            topic["last"] = message.sequence
        for attachment in reader.iter_attachments():
            found["attachments"][attachment.name] = len(attachment.data)
        for metadata in reader.iter_metadata():
            found["metadata"].update(metadata.metadata)


def main():
    found = {"topics": {}, "messages": {}, "attachments": {}, "metadata": {}, "span": [0, 0]}
    for path in sys.argv[1:]:
        read(path, found)
    json.dump(found, sys.stdout)


main()
