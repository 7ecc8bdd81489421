"""Reads what a CMakeLists.txt says about interfaces: enough of CMake's language for what people write there."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

_COMMENT = re.compile(r"#\[(=*)\[.*?\]\1\]|#[^\n]*", re.DOTALL)
_COMMAND = re.compile(r"^[ \t]*([A-Za-z_]\w*)[ \t]*\(", re.MULTILINE)
_ARGUMENT = re.compile(r'"((?:[^"\\]|\\.)*)"|([^\s()"]+)|(\()|(\))')
_VARIABLE = re.compile(r"\$\{([\w-]+)\}")
_KEYWORDS = ("DEPENDENCIES", "LIBRARY_NAME", "SKIP_INSTALL", "SKIP_GROUP_MEMBERSHIP_CHECK", "ADD_LINTER_TESTS")
GENERATE = "rosidl_generate_interfaces"


@dataclass(frozen=True, slots=True)
class Command:
    """One call in a CMakeLists.txt, its variables replaced by their values where these are known."""

    name: str
    arguments: tuple[str, ...]
    line: int


@dataclass(frozen=True, slots=True)
class CMakeLists:
    """What is said about interfaces.

    `files`, as listed, relative to the package; None if they are not spelled out but, say, globbed. `line` is that of
    `rosidl_generate_interfaces`, and None if it is not called. `finds_build_depends`: whether ament_cmake_auto finds
    the packages that package.xml names as needed for the build, as well as those in `found`.
    """

    project: str
    found: tuple[str, ...]
    files: tuple[str, ...] | None
    dependencies: tuple[str, ...]
    line: int | None
    ends_with_package: bool
    finds_build_depends: bool = False


def read_cmake_lists(text: str) -> CMakeLists:
    """Read the text of a CMakeLists.txt."""
    variables: dict[str, tuple[str, ...]] = {}
    loops: dict[str, tuple[str, ...]] = {}
    found: list[str] = []
    project, line, ends, finds_all = "", None, False, False
    listed: list[str] = []
    dependencies: list[str] = []
    for command in _commands(text):
        arguments = tuple(value for argument in command.arguments for value in _expanded(argument, variables))
        match command.name:
            case "project" if arguments:
                project = arguments[0]
                variables["PROJECT_NAME"] = (project,)
            case "set" if arguments:
                variables[arguments[0]] = arguments[1:]
            case "list" if len(arguments) > 1 and arguments[0] == "APPEND":
                variables[arguments[1]] = (*variables.get(arguments[1], ()), *arguments[2:])
            case "foreach" if arguments:
                loops[f"${{{arguments[0]}}}"] = tuple(_items(arguments[1:], variables))
            case "find_package" if arguments:
                found += loops.get(arguments[0], arguments[:1])
            case "ament_auto_find_build_dependencies":
                finds_all = True
            case "ament_package" | "ament_auto_package":
                ends = True
            case "rosidl_generate_interfaces":
                line = command.line
                files, packages = _split(arguments[1:])
                listed += files
                dependencies += packages
    unknown = any("$" in file or "*" in file for file in listed)
    spelled_out = None if unknown else tuple(dict.fromkeys(file.removeprefix("./") for file in listed))
    return CMakeLists(project, tuple(found), spelled_out, tuple(dict.fromkeys(dependencies)), line, ends, finds_all)


def _commands(text: str) -> Iterator[Command]:
    text = _COMMENT.sub(lambda comment: re.sub(r"[^\n]", " ", comment[0]), text)
    for start in _COMMAND.finditer(text):
        arguments: list[str] = []
        depth = 1
        for argument in _ARGUMENT.finditer(text, start.end()):
            depth += bool(argument[3]) - bool(argument[4])
            if depth == 0:
                yield Command(start[1].lower(), tuple(arguments), text.count("\n", 0, start.start(1)) + 1)
                break
            if argument[1] is not None or argument[2]:
                arguments.append(argument[1] if argument[1] is not None else argument[2])


def _expanded(argument: str, variables: dict[str, tuple[str, ...]]) -> tuple[str, ...]:
    """Replace variables; an argument that is nothing but a list's name becomes its elements."""
    if (whole := _VARIABLE.fullmatch(argument)) and whole[1] in variables:
        return variables[whole[1]]
    if argument == "${CMAKE_CURRENT_SOURCE_DIR}":
        return (".",)
    text = argument.replace("${CMAKE_CURRENT_SOURCE_DIR}/", "")
    text = _VARIABLE.sub(lambda name: ";".join(variables.get(name[1], (name[0],))), text)
    return tuple(text.split(";")) if ";" in text else (text,)


def _items(arguments: tuple[str, ...], variables: dict[str, tuple[str, ...]]) -> Iterator[str]:
    """What a foreach() goes through, given its arguments after the variable."""
    keyword = ""
    for argument in arguments:
        if argument in ("IN", "LISTS", "ITEMS", "RANGE"):
            keyword = argument
        elif keyword == "LISTS":
            yield from variables.get(argument, ())
        elif keyword != "RANGE":
            yield argument


def _split(arguments: tuple[str, ...]) -> tuple[list[str], list[str]]:
    """Return the files and the packages among the arguments that follow the target's name."""
    files: list[str] = []
    packages: list[str] = []
    keyword = ""
    for argument in arguments:
        if argument in _KEYWORDS:
            keyword = argument
        elif keyword == "DEPENDENCIES":
            packages.append(argument)
        elif keyword != "LIBRARY_NAME":
            files.append(argument)
    return files, packages
