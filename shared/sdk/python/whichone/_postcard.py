"""The encoding of messages without a fixed layout: postcard (https://postcard.jamesmunns.com/wire-format).

Integers of more than a byte are variable-length, fields follow one another without names, and lists, texts and
alternatives begin with their count or number.
"""

from __future__ import annotations

import struct as _struct
from dataclasses import fields as _fields
from enum import IntEnum
from typing import Any, Callable, TypeVar

from ._fixed import InvalidMessage

T = TypeVar("T")


class Input:
    """Encoded bytes that are read from front to back."""

    def __init__(self, data: bytes) -> None:
        self.data, self.at = data, 0

    def take(self, count: int) -> bytes:
        """The next bytes."""
        end = self.at + count
        if end > len(self.data):
            raise InvalidMessage(f"expected {count} bytes at {self.at}, found {len(self.data) - self.at}")
        part, self.at = self.data[self.at:end], end
        return part

    def unsigned(self) -> int:
        """A number of variable length."""
        value = 0
        for shift in range(0, 70, 7):
            byte = self.take(1)[0]
            value |= (byte & 0x7F) << shift
            if byte < 0x80:
                return value
        raise InvalidMessage(f"a number at {self.at} has no end")

    def count(self) -> int:
        """Number of entries of a list, each of which takes a byte at least."""
        count = self.unsigned()
        if count > len(self.data) - self.at:
            raise InvalidMessage(f"{count} entries at {self.at} do not fit into {len(self.data)} bytes")
        return count


def put_unsigned(out: bytearray, value: int) -> None:
    """Appends a number of variable length."""
    if not 0 <= value < 1 << 64:
        raise InvalidMessage(f"expected a number from 0 to 2^64 - 1, found {value}")
    while value >= 0x80:
        out.append(value & 0x7F | 0x80)
        value >>= 7
    out.append(value)


class Encoding:
    """How values of a type are encoded."""

    def read(self, data: Input) -> Any:
        """The value that comes next."""
        raise NotImplementedError

    def write(self, out: bytearray, value: Any) -> None:
        """Appends a value."""
        raise NotImplementedError


class _Packed(Encoding):
    def __init__(self, form: str) -> None:
        self.packed = _struct.Struct(form)

    def read(self, data: Input) -> Any:
        return self.packed.unpack(data.take(self.packed.size))[0]

    def write(self, out: bytearray, value: Any) -> None:
        out += self.packed.pack(value)


class _Bool(Encoding):
    def read(self, data: Input) -> bool:
        byte = data.take(1)[0]
        if byte > 1:
            raise InvalidMessage(f"expected 0 or 1, found {byte}")
        return byte == 1

    def write(self, out: bytearray, value: bool) -> None:
        out.append(bool(value))


class _Unsigned(Encoding):
    def read(self, data: Input) -> int:
        return data.unsigned()

    def write(self, out: bytearray, value: int) -> None:
        put_unsigned(out, value)


class _Signed(Encoding):
    def read(self, data: Input) -> int:
        value = data.unsigned()
        return (value >> 1) ^ -(value & 1)

    def write(self, out: bytearray, value: int) -> None:
        put_unsigned(out, value << 1 if value >= 0 else (-value << 1) - 1)


class _Str(Encoding):
    def read(self, data: Input) -> str:
        try:
            return data.take(data.count()).decode()
        except UnicodeDecodeError as error:
            raise InvalidMessage(f"a text is not UTF-8: {error}") from None

    def write(self, out: bytearray, value: str) -> None:
        text = value.encode()
        put_unsigned(out, len(text))
        out += text


BOOL, U8, UNSIGNED, SIGNED = _Bool(), _Packed("<B"), _Unsigned(), _Signed()
F32, F64, STR = _Packed("<f"), _Packed("<d"), _Str()


class Bytes(Encoding):
    """A fixed number of bytes."""

    def __init__(self, size: int) -> None:
        self.size = size

    def read(self, data: Input) -> bytes:
        return bytes(data.take(self.size))

    def write(self, out: bytearray, value: bytes) -> None:
        if len(value) != self.size:
            raise InvalidMessage(f"expected {self.size} bytes, found {len(value)}")
        out += value


class Optional(Encoding):
    """A value or none."""

    def __init__(self, inner: Encoding) -> None:
        self.inner = inner

    def read(self, data: Input) -> Any:
        return self.inner.read(data) if BOOL.read(data) else None

    def write(self, out: bytearray, value: Any) -> None:
        out.append(value is not None)
        if value is not None:
            self.inner.write(out, value)


class Sequence(Encoding):
    """A list."""

    def __init__(self, inner: Encoding) -> None:
        self.inner = inner

    def read(self, data: Input) -> list[Any]:
        return [self.inner.read(data) for _ in range(data.count())]

    def write(self, out: bytearray, value: Any) -> None:
        put_unsigned(out, len(value))
        for one in value:
            self.inner.write(out, one)


class Fixed(Encoding):
    """A list of a fixed number of entries."""

    def __init__(self, inner: Encoding, size: int) -> None:
        self.inner, self.size = inner, size

    def read(self, data: Input) -> list[Any]:
        return [self.inner.read(data) for _ in range(self.size)]

    def write(self, out: bytearray, value: Any) -> None:
        if len(value) != self.size:
            raise InvalidMessage(f"expected {self.size} entries, found {len(value)}")
        for one in value:
            self.inner.write(out, one)


class Tuple(Encoding):
    """Values of different types."""

    def __init__(self, *parts: Encoding) -> None:
        self.parts = parts

    def read(self, data: Input) -> tuple[Any, ...]:
        return tuple(part.read(data) for part in self.parts)

    def write(self, out: bytearray, value: Any) -> None:
        for part, one in zip(self.parts, value, strict=True):
            part.write(out, one)


class Codes(Encoding):
    """An enum without data."""

    def __init__(self, codes: type[IntEnum]) -> None:
        self.codes = codes

    def read(self, data: Input) -> IntEnum:
        code = data.unsigned()
        try:
            return self.codes(code)
        except ValueError:
            raise InvalidMessage(f"expected a {self.codes.__name__}, found {code}") from None

    def write(self, out: bytearray, value: IntEnum) -> None:
        put_unsigned(out, self.codes(value).value)


class Nested(Encoding):
    """A class that `struct` has given an encoding."""

    def __init__(self, of: type) -> None:
        self.of = of

    def read(self, data: Input) -> Any:
        return self.of(**{name: part.read(data) for name, part in self.of.encodings.items()})

    def write(self, out: bytearray, value: Any) -> None:
        if not isinstance(value, self.of):
            raise InvalidMessage(f"expected a {self.of.__name__}, found {value!r}")
        for name, part in self.of.encodings.items():
            part.write(out, getattr(value, name))


class Variants(Encoding):
    """One of several classes, by its number."""

    def __init__(self, variants: dict[int, type]) -> None:
        self.variants = {code: Nested(variant) for code, variant in variants.items()}
        self.codes = {variant: code for code, variant in variants.items()}

    def read(self, data: Input) -> Any:
        code = data.unsigned()
        if code not in self.variants:
            known = ", ".join(variant.__name__ for variant in self.codes)
            raise InvalidMessage(f"expected one of {known}, found number {code}")
        return self.variants[code].read(data)

    def write(self, out: bytearray, value: Any) -> None:
        code = self.codes.get(type(value))
        if code is None:
            known = ", ".join(variant.__name__ for variant in self.codes)
            raise InvalidMessage(f"expected one of {known}, found {value!r}")
        put_unsigned(out, code)
        self.variants[code].write(out, value)


def struct(**encodings: Encoding) -> Callable[[type[T]], type[T]]:
    """Gives a dataclass its encoding: that of each field, in order."""
    def decorate(cls: type[T]) -> type[T]:
        assert [it.name for it in _fields(cls)] == list(encodings), cls  # type: ignore[arg-type]
        cls.encodings = encodings  # type: ignore[attr-defined]
        return cls
    return decorate


def encode(value: Any) -> bytes:
    """The bytes of a message."""
    out = bytearray()
    Nested(type(value)).write(out, value)
    return bytes(out)


def decode(cls: type[T], data: bytes) -> T:
    """The message in these bytes. Raises `InvalidMessage`."""
    source = Input(data)
    value = Nested(cls).read(source)
    if source.at != len(data):
        raise InvalidMessage(f"{len(data) - source.at} bytes are left after a {cls.__name__}")
    return value
