"""JSON by the types of our dataclasses. What is read is checked against them: a ValueError tells what does not fit."""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import Any


class LineCodec[T]:
    """Objects of several dataclasses, each as one line of JSON; `tag` is the key under which its class is named."""

    def __init__(self, tag: str, kinds: Iterable[type[T]]) -> None:
        self._tag = tag
        self._kinds = {kind.__name__: kind for kind in kinds}

    def encode(self, value: T) -> str:
        """Write it, without the line's end.

        In ASCII: the same bytes in every locale, and no character that some reader would take for a line's end.
        """
        import msgspec  # late, as below: the first paint does not wait for it

        return json.dumps({self._tag: type(value).__name__, **msgspec.to_builtins(value)})

    def decode(self, line: str) -> T:
        """Read what `encode` wrote. Raises ValueError for any other line."""
        import msgspec

        try:
            fields = json.loads(line)
            return msgspec.convert(fields, self._kinds[fields[self._tag]])
        except (KeyError, TypeError, ValueError, RecursionError) as error:
            raise ValueError(f"not understood: {line[:200]!r}") from error


def write_document(schema: str, **members: Any) -> str:
    """One of our files as JSON, to be read by people, too: `schema` names its format and version."""
    import msgspec

    return json.dumps({"schema": schema, **msgspec.to_builtins(members)}, ensure_ascii=False, indent=1) + "\n"


def read_document(text: str, schema: str) -> dict[str, Any]:
    """The members of what `write_document` wrote, for `read_member`. Raises ValueError, which says what is wrong."""
    try:
        document = json.loads(text)
        found = document["schema"]
    except (KeyError, TypeError, ValueError, RecursionError) as error:
        raise ValueError("it is damaged") from error
    if found != schema:
        family, _, version = str(found).rpartition("/")
        newer = family == schema.rpartition("/")[0] and version.isdecimal() and int(version) > 1
        raise ValueError("a newer ros-tutor wrote it" if newer else "it is damaged")
    return {str(key): value for key, value in document.items()}


def read_as[T](kind: type[T], value: Any) -> T:
    """A value of JSON as this type. Raises ValueError; members that the type does not know are passed over."""
    import msgspec

    try:
        return msgspec.convert(value, kind)
    except msgspec.ValidationError as error:
        raise ValueError("it is damaged") from error
