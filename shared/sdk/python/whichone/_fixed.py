"""What messages of fixed layout have in common."""

from __future__ import annotations

import ctypes
from dataclasses import dataclass
from enum import IntEnum
from functools import cache
from typing import Any, ClassVar

Array = ctypes.Array


class InvalidMessage(ValueError):
    """A message that holds what its type does not allow."""


class Message(ctypes.Structure):
    """A message that lies in shared memory as it is."""

    wire_name: ClassVar[str]
    """Name of the type, equal in every language."""
    wire_size: ClassVar[int]
    """Bytes."""
    schema_key: ClassVar[str]
    """Key of the layout, which both sides of a topic must agree on."""
    codes: ClassVar[dict[str, type[IntEnum]]]
    """Fields that hold the code of an enum."""

    @classmethod
    def type_name(cls) -> str:
        """Name of the type for iceoryx2."""
        return cls.wire_name

    @classmethod
    def check_layout(cls) -> None:
        """Checks that this interpreter lays the fields out as the group's programs do."""
        if ctypes.sizeof(cls) != cls.wire_size:
            raise TypeError(f"{cls.__name__}: expected {cls.wire_size} bytes, found {ctypes.sizeof(cls)}; "
                            "help: whichone runs on 64-bit little-endian machines")

    @classmethod
    @cache
    def _parts(cls) -> tuple[str, ...]:
        """Fields that hold other messages with codes."""
        def is_coded(kind: Any) -> bool:
            while issubclass(kind, ctypes.Array):
                kind = kind._type_
            return issubclass(kind, Message) and bool(kind.codes or kind._parts())
        return tuple(name for name, kind in cls._fields_ if is_coded(kind))

    def validate(self) -> None:
        """Checks the codes inside. Raises `InvalidMessage` for one that its enum does not have."""
        for field, codes in self.codes.items():
            code = getattr(self, field)
            if code not in codes._value2member_map_:
                known = ", ".join(f"{it.value} {it.name}" for it in codes)
                raise InvalidMessage(f"{self.wire_name}.{field}: expected a {codes.__name__} ({known}), found {code}")
        for field in self._parts():
            part = getattr(self, field)
            for one in part if isinstance(part, ctypes.Array) else (part,):
                one.validate()

    def copy(self) -> Any:
        """A message of its own with the same content."""
        return type(self).from_buffer_copy(self)

    def __repr__(self) -> str:
        fields = ((name, getattr(self, name)) for name, *_ in self._fields_ if name != "reserved")
        shown = (f"{name}={list(value) if isinstance(value, ctypes.Array) else value!r}" for name, value in fields)
        return f"{type(self).__name__}({', '.join(shown)})"


class Text(ctypes.Structure):
    """Text of bounded length: `str(message.text)` reads it, `message.text.set(…)` writes it."""

    def __str__(self) -> str:
        return bytes(self.bytes[:min(self.len, len(self.bytes))]).decode(errors="replace")

    def __repr__(self) -> str:
        return repr(str(self))

    def set(self, text: str) -> None:
        """Writes the text. One that is too long loses its end, between characters."""
        data = text.encode()
        if len(data) > len(self.bytes):
            data = data[:len(self.bytes)].decode(errors="ignore").encode()
        self.len = len(data)
        self.bytes[:] = data.ljust(len(self.bytes), b"\0")


@cache
def fixed_text(size: int) -> type[Text]:
    """The type of texts of at most `size` bytes."""
    fields = [("len", ctypes.c_uint32), ("bytes", ctypes.c_uint8 * size)]
    return type(f"Text{size}", (Text,), {"_fields_": fields})


@dataclass(frozen=True)
class Topic:
    """One topic."""

    name: str
    message: type
    """A `Message`, or a dataclass with an encoding."""
    writer: str | None
    """The service that writes it; none where clients do."""
    wakes: tuple[str, ...]
    """Services that are woken after a message."""
    buffer: int
    """Unread messages that a reader holds; the oldest gives way."""
    history: int
    """Messages that a late reader still gets."""
