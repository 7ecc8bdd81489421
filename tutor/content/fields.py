"""Strict YAML reading: every wrong, missing or misspelt field is an error that names its file and line."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import yaml

from tutor.errors import ContentError

# The C parser is about ten times faster, but PyYAML may be built without it. Both are safe loaders.
_Loader: type[Any] = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


def read_text(file: Path) -> str:
    """Return the text of a file of a course. Raises ContentError."""
    try:
        return file.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "it is not UTF-8 text"
        raise ContentError(file, f"cannot read it: {reason}") from error


class Document:
    """A YAML text and its place in a file. `offset` is the number of lines of the file before the text."""

    def __init__(self, file: Path, text: str, offset: int = 0) -> None:
        self.file = file
        self._text = text
        self._offset = offset

    @classmethod
    def of(cls, file: Path) -> Document:
        """Return a file that holds nothing else. Raises ContentError if it cannot be read."""
        return cls(file, read_text(file))

    def read(self) -> Fields:
        """Parse the text, whose outermost value must be a mapping.

        Raises ContentError.
        """
        try:
            value = yaml.load(self._text, Loader=_Loader)
        except yaml.MarkedYAMLError as error:
            mark = error.problem_mark or error.context_mark
            line = None if mark is None else mark.line + 1 + self._offset
            raise ContentError(self.file, f"not valid YAML: {error.problem}", line=line) from error
        except yaml.YAMLError as error:
            raise ContentError(self.file, f"not valid YAML: {error}") from error
        return Fields(self, (), value)

    def error(self, path: tuple[str | int, ...], message: str) -> ContentError:
        """Return an error about the value at `path`, with its line number or that of the nearest enclosing value."""
        field = "".join(f"[{step + 1}]" if isinstance(step, int) else f".{step}" for step in path).lstrip(".")
        return ContentError(self.file, message, line=self._line(path), field=field)

    def _line(self, path: tuple[str | int, ...]) -> int:
        # Line numbers cost a second parse, so they are looked up only for an error.
        node = yaml.compose(self._text, Loader=_Loader)
        line = node.start_mark.line if node is not None else 0
        for step in path:
            if isinstance(node, yaml.SequenceNode) and isinstance(step, int):
                node = node.value[step]
                line = node.start_mark.line
            elif isinstance(node, yaml.MappingNode):
                found = [(key, value) for key, value in node.value if key.value == step]
                if not found:
                    break
                key, node = found[-1]
                line = key.start_mark.line
        return int(line) + 1 + self._offset


class Fields:
    """A mapping whose fields are taken one by one, each with its expected type; `done` rejects the rest.

    Every method raises ContentError for a value of another type.
    """

    def __init__(self, document: Document, path: tuple[str | int, ...], value: object) -> None:
        self._document = document
        self._path = path
        if not isinstance(value, dict):
            raise document.error(path, f"expected fields (name: value), found {_describe_type(value)}")
        self._remaining = dict(value)

    def text(self, name: str, *, optional: bool = False) -> str:
        """Take a non-empty text, with surrounding whitespace stripped; "" if `optional` and absent."""
        if optional and name not in self._remaining:
            return ""
        return self._text((*self._path, name), self._take(name))

    def flag(self, name: str, default: bool) -> bool:
        """Take a boolean; `default` if absent."""
        value = self._remaining.pop(name, default)
        if not isinstance(value, bool):
            raise self.error(name, f"expected true or false, found {_describe_type(value)}")
        return value

    def texts(self, name: str, *, optional: bool = False) -> tuple[str, ...]:
        """Take a list of texts; empty if `optional` and absent."""
        return self._list(name, optional, self._text)

    def anything(self, name: str) -> object:
        """Take a value of any type, which the caller validates; None if absent."""
        return self._remaining.pop(name, None)

    def number(self, name: str) -> float | None:
        """Take a number; None if absent."""
        value = self._remaining.pop(name, None)
        if value is not None and (isinstance(value, bool) or not isinstance(value, (int, float))):
            raise self.error(name, f"expected a number, found {_describe_type(value)}")
        return None if value is None else float(value)

    def mapping(self, name: str) -> Fields | None:
        """Take a mapping; None if absent."""
        value = self._remaining.pop(name, None)
        return None if value is None else Fields(self._document, (*self._path, name), value)

    def mappings(self, name: str, *, optional: bool = False) -> tuple[Fields, ...]:
        """Take a list of mappings; empty if `optional` and absent."""
        return self._list(name, optional, lambda path, value: Fields(self._document, path, value))

    def done(self) -> None:
        """Reject fields that were not taken: most often they are misspelt."""
        for name in self._remaining:
            raise self.error(str(name), "there is no such field")

    def error(self, name: str, message: str) -> ContentError:
        """Return an error about one field of this mapping."""
        return self._document.error((*self._path, name), message)

    def _take(self, name: str) -> object:
        if name not in self._remaining:
            raise self.error(name, "this field is missing")
        return self._remaining.pop(name)

    def _text(self, path: tuple[str | int, ...], value: object) -> str:
        if not isinstance(value, str) or not value.strip():
            raise self._document.error(path, f"expected a text, found {_describe_type(value)}")
        return value.strip()

    def _list[T](self, name: str, optional: bool, read: Callable[[tuple[str | int, ...], object], T]) -> tuple[T, ...]:
        if optional and name not in self._remaining:
            return ()
        value = self._take(name)
        if not isinstance(value, list):
            raise self.error(name, f"expected a list, found {_describe_type(value)}")
        return tuple(read((*self._path, name, index), item) for index, item in enumerate(value))


def _describe_type(value: object) -> str:
    if value is None or value == "":
        return "nothing"
    names = {str: "a text", bool: "true or false", int: "a number", float: "a number", list: "a list", dict: "fields"}
    return names.get(type(value), f"a {type(value).__name__}")
