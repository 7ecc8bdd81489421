"""Checks .msg, .srv and .action files line by line: rosidl's own rules, and their violations in words with a place.

The generators know no lines. They also accept names that no compiler or Python does, which would fail much later.
"""

from __future__ import annotations

import difflib
import keyword
import re
from collections.abc import Callable, Iterator
from pathlib import Path

from tutor.interfaces.problem import Problem
from tutor.workspace.regular import read_regular

KINDS = ("msg", "srv", "action")
SECTIONS = {"msg": ("message",), "srv": ("request", "response"), "action": ("goal", "result", "feedback")}
MAX_BYTES = 100_000
"""Size limit of a file that is read."""

PRIMITIVES = (
    *("bool", "byte", "char", "float32", "float64", "string", "wstring"),
    *(f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)),
)

TypeExists = Callable[[str, str], str]
"""Why a message type (of a package and a name) cannot be used; empty if it can."""

_OTHER_NAMES = {
    **dict.fromkeys(("double", "Float64", "real"), "float64"),
    **dict.fromkeys(("float", "Float32", "single"), "float32"),
    **dict.fromkeys(("int", "Int32", "integer", "int32_t"), "int32"),
    **dict.fromkeys(("uint", "unsigned", "uint32_t"), "uint32"),
    **dict.fromkeys(("long", "Int64", "int64_t"), "int64"),
    **dict.fromkeys(("short", "int16_t"), "int16"),
    **dict.fromkeys(("uint8_t", "octet", "bytes"), "uint8"),
    **dict.fromkeys(("str", "String", "text"), "string"),
    **dict.fromkeys(("boolean", "Bool"), "bool"),
    **dict.fromkeys(("time", "Time"), "builtin_interfaces/Time"),
    **dict.fromkeys(("duration", "Duration"), "builtin_interfaces/Duration"),
    "Header": "std_msgs/Header",
}
# Each field also becomes a member of a C and a C++ structure.
_C_KEYWORDS = (
    "alignas alignof and_eq asm auto bitand bitor bool break case catch char class compl const const_cast constexpr"
    " continue decltype default delete do double dynamic_cast else enum explicit export extern false float for friend"
    " goto if inline int long mutable namespace new noexcept not_eq nullptr operator or_eq private protected public"
    " register reinterpret_cast restrict return short signed sizeof static static_assert static_cast struct switch"
    " template this thread_local throw true try typedef typeid typename union unsigned using virtual void volatile"
    " wchar_t while xor xor_eq"
)
_FILE_NAME = re.compile(r"[A-Z][A-Za-z0-9]*")
_FIELD_NAME = re.compile(r"[a-z](?:_?[a-z0-9])*")
_CONSTANT_NAME = re.compile(r"[A-Z](?:_?[A-Z0-9])*")
_TYPE = re.compile(r"(?P<base>[\w/]+)(?P<length><=\d+)?(?P<array>\[(?:<=)?\d*\])?")


def problems_of(package: str, file: Path, type_exists: TypeExists) -> Iterator[Problem]:
    """Yield what is wrong in a file of a package, in the order of its lines. Raises OSError."""
    kind = file.suffix[1:]
    if not _FILE_NAME.fullmatch(file.stem):
        name = _camel_case(file.stem)
        yield Problem(file, None, f"a type's name is in CamelCase, and so is its file's: {name}.{kind}")
    content = read_regular(file, MAX_BYTES)
    if content is None:
        yield Problem(file, None, f"this is not a file of at most {MAX_BYTES // 1000} kB")
        return
    try:
        lines = content.decode("utf-8-sig").splitlines()
    except UnicodeDecodeError:
        yield Problem(file, None, "the file is not UTF-8")
        return
    separators = [number for number, line in enumerate(lines, 1) if line.rstrip() == "---"]
    sections = SECTIONS[kind]
    if len(separators) != len(sections) - 1:
        yield Problem(file, separators[-1] if separators else None, _about_separators(kind, len(separators)))
        return
    seen: dict[str, int] = {}
    for number, line in enumerate(lines, 1):
        if number in separators:
            seen = {}
            continue
        if reason := _reason(package, line, number, seen, type_exists):
            yield Problem(file, number, reason)


def definition_of(file: Path) -> tuple[str, ...]:
    """Return the fields of a file without problems, each as in "float64 value", and --- between its parts."""
    found = []
    for line in file.read_text(encoding="utf-8-sig").splitlines():
        words = line.partition("#")[0].split()
        if words == ["---"]:
            found.append("---")
        elif len(words) > 1 and "=" not in "".join(words[1:]):
            found.append(f"{words[0]} {words[1]}")
    return tuple(found)


def _about_separators(kind: str, count: int) -> str:
    names = SECTIONS[kind]
    if kind == "msg":
        return "a line --- separates the parts of a .srv or .action file; a message has only one part"
    needed = "one line ---" if len(names) == 2 else "two lines ---"
    parts = f"{', '.join(names[:-1])} and {names[-1]}"
    return f"a .{kind} file has {needed} between {parts}, and this one has {count or 'none'}"


def _reason(package: str, line: str, number: int, seen: dict[str, int], type_exists: TypeExists) -> str:
    """Return what is wrong with one line; empty if nothing is."""
    code, _, comment = line.replace("\t", " ").partition("#")
    code = code.rstrip()
    if "*/" in comment or comment.rstrip().endswith("\\"):
        return "a comment becomes one of C++: it can neither have */ in it nor a backslash at its end"
    if not code:
        return ""
    if code.startswith(" "):
        return "a definition starts at the beginning of its line, and this one is indented"
    type_text, _, rest = code.partition(" ")
    rest = rest.strip()
    if type_text.endswith((":", ",")):
        return "a field is written as its type, a space and its name, such as float64 value"
    if code.endswith(";"):
        return "a line of a definition ends without a semicolon"
    if reason := _about_type(type_text, type_exists):
        return reason
    if not rest:
        return f"the type {type_text} is followed by no name"
    is_constant = "=" in rest  # to rosidl, even where it is in a string
    name = rest.partition("=")[0].strip() if is_constant else rest.partition(" ")[0]
    if name in seen:
        return f"the name {name} is already used in line {seen[name]}"
    seen[name] = number
    about_name = _about_constant(name) if is_constant else _about_field(name)
    return about_name or _by_rosidl(package, type_text, rest, is_constant)


def _about_type(text: str, type_exists: TypeExists) -> str:
    found = _TYPE.fullmatch(text)
    if found is None:
        return f"{text!r} is not a type: one is written like float64, float64[], float64[3] or string<=10"
    base = found["base"]
    if base in PRIMITIVES:
        bounded = found["length"] and base not in ("string", "wstring")
        return f"only a string has a length, and {base} is none" if bounded else ""
    if base in _OTHER_NAMES and type_exists("", base):
        return f"there is no type {base} in a definition; it is {_OTHER_NAMES[base]}"
    owner, _, name = base.rpartition("/")
    if "/" in owner:
        return f"in a definition, a type is written without the folder: {owner.partition('/')[0]}/{name}, not {base}"
    if not owner and name.islower():
        near = difflib.get_close_matches(name, PRIMITIVES, n=1)
        return f"there is no type {base}" + (f"; is it {near[0]}?" if near else "")
    return type_exists(owner, name)


def _about_field(name: str) -> str:
    if not _FIELD_NAME.fullmatch(name):
        return f"the name of a field is in lower_snake_case, and {name!r} is not"
    if keyword.iskeyword(name) or name in _C_KEYWORDS.split():
        language = "Python" if keyword.iskeyword(name) else "C++"
        return f"{name} is a keyword of {language}, so it cannot be the name of a field"
    return ""


def _about_constant(name: str) -> str:
    if _CONSTANT_NAME.fullmatch(name):
        return ""
    return (
        f"with an =, the line is a constant, whose name is in UPPER_CASE, and {name!r} is not;"
        " a field's default value follows its name without an ="
    )


def _by_rosidl(package: str, type_text: str, rest: str, is_constant: bool) -> str:
    """Return what rosidl itself has against a line, such as a value that the type cannot have."""
    from rosidl_adapter.parser import Constant, Field, InvalidSpecification, InvalidValue, Type

    name, _, value = rest.partition("=" if is_constant else " ")
    try:
        if is_constant:
            Constant(type_text, name.strip(), value.strip())
        else:
            Field(Type(type_text, context_package_name=package), name, value.strip() or None)
    except (InvalidSpecification, InvalidValue, ValueError, TypeError, NameError, NotImplementedError) as error:
        return " ".join(str(error).split())
    return ""


def _camel_case(text: str) -> str:
    return "".join(part[:1].upper() + part[1:] for part in re.split(r"[^A-Za-z0-9]+", text)) or "Name"
