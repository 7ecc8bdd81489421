"""JSON from and to our dataclasses. Input is validated against their types; a ValueError says what is wrong."""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import Any


class LineCodec[T]:
    """Encodes objects of several dataclasses as one line of JSON each, with the class name under the key `tag`."""

    def __init__(self, tag: str, kinds: Iterable[type[T]]) -> None:
        self._tag = tag
        self._kinds = {kind.__name__: kind for kind in kinds}

    def encode(self, value: T) -> str:
        """Encode an object, without a trailing newline.

        The result is ASCII: the same bytes in any locale, and no character that a reader could take for a line break.
        """
        import msgspec  # imported late, as below, so that it does not delay the first paint

        return json.dumps({self._tag: type(value).__name__, **msgspec.to_builtins(value)})

    def decode(self, line: str) -> T:
        """Decode a line from `encode`. Raises ValueError for any other line."""
        import msgspec

        try:
            fields = json.loads(line)
            return msgspec.convert(fields, self._kinds[fields[self._tag]])
        except (KeyError, TypeError, ValueError, RecursionError) as error:
            raise ValueError(f"not understood: {line[:200]!r}") from error


def write_document(schema: str, **members: Any) -> str:
    """Return the JSON text of one of our files, readable for people too. `schema` names its format and version."""
    import msgspec

    return json.dumps({"schema": schema, **msgspec.to_builtins(members)}, ensure_ascii=False, indent=1) + "\n"


def read_document(text: str, schema: str, *former: str) -> dict[str, Any]:
    """Return the members of a document from `write_document`, to be passed to `convert_to`. Raises ValueError.

    `former`: earlier versions of the schema that the caller understands, too; the member `schema` says which it is.
    """
    try:
        document = json.loads(text)
        found = document["schema"]
    except (KeyError, TypeError, ValueError, RecursionError) as error:
        raise ValueError("it is damaged") from error
    if found not in (schema, *former):
        (family, _, version), (ours, _, current) = str(found).rpartition("/"), schema.rpartition("/")
        newer = family == ours and version.isdecimal() and int(version) > int(current)
        raise ValueError("a newer ros-tutor wrote it" if newer else "it is damaged")
    return {str(key): value for key, value in document.items()}


def convert_to[T](kind: type[T], value: Any) -> T:
    """Convert a JSON value to a type, ignoring members that the type does not have. Raises ValueError."""
    import msgspec

    try:
        return msgspec.convert(value, kind)
    except msgspec.ValidationError as error:
        raise ValueError("it is damaged") from error
