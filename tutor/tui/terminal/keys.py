"""What a terminal sends to its program for a key, a paste, and the mouse wheel, as xterm does."""

from __future__ import annotations

_NAMED = {
    "enter": b"\r",
    "tab": b"\t",
    "shift+tab": b"\x1b[Z",
    "escape": b"\x1b",
    "backspace": b"\x7f",
    "space": b" ",
    "ctrl+@": b"\0",
    "ctrl+space": b"\0",
    "ctrl+backslash": b"\x1c",
    "ctrl+right_square_bracket": b"\x1d",
    "ctrl+circumflex_accent": b"\x1e",
    "ctrl+underscore": b"\x1f",
    "ctrl+backspace": b"\x08",
}
_CURSOR = {"up": "A", "down": "B", "right": "C", "left": "D", "end": "F", "home": "H"}
_EDITING = {"insert": 2, "delete": 3, "pageup": 5, "pagedown": 6}
_MODIFIERS = {"shift": 1, "alt": 2, "ctrl": 4}

PASTE_START, PASTE_END = b"\x1b[200~", b"\x1b[201~"


def key_bytes(key: str, character: str | None, *, application_cursor: bool = False) -> bytes:
    r"""Return what is sent for a key, by Textual's name of it; nothing for a key that has no meaning in a terminal.

    `application_cursor`: the program has asked for the other form of the cursor keys.

    >>> key_bytes("up", None), key_bytes("ctrl+c", None), key_bytes("alt+b", "b"), key_bytes("ctrl+right", None)
    (b'\x1b[A', b'\x03', b'\x1bb', b'\x1b[1;5C')
    """
    if key in _NAMED:
        return _NAMED[key]
    *modifiers, name = key.split("+") if key != "+" else [key]
    code = 1 + sum(_MODIFIERS.get(modifier, 0) for modifier in modifiers)
    if name in _CURSOR:
        plain = "\x1bO" if application_cursor else "\x1b["
        return f"{plain if code == 1 else f'\x1b[1;{code}'}{_CURSOR[name]}".encode()
    if name in _EDITING:
        return f"\x1b[{_EDITING[name]}{f';{code}' if code > 1 else ''}~".encode()
    if "alt" in modifiers:
        rest = "+".join(modifier for modifier in (*modifiers, name) if modifier != "alt")
        shifted = name.upper() if len(name) == 1 and "shift" in modifiers else name
        return b"\x1b" + key_bytes(rest, character or (shifted if len(shifted) == 1 else None))
    if "ctrl" in modifiers and len(name) == 1 and "a" <= name.lower() <= "z":
        return bytes([ord(name.lower()) - 96])
    if name in ("enter", "tab", "backspace", "escape", "space"):
        return _NAMED[name]
    return character.encode("utf-8", "replace") if character and character.isprintable() else b""


def paste_bytes(text: str, *, bracketed: bool) -> bytes:
    """Return what is sent for pasted text. No control character but newlines and tabs gets through.

    `bracketed`: the program has asked to be told what is pasted; no text can end that early then.
    """
    kept = "".join(c for c in text.replace("\r\n", "\n") if c in "\n\t" or (c >= " " and not "\x7f" <= c <= "\x9f"))
    data = kept.replace("\n", "\r").encode("utf-8", "replace")
    return PASTE_START + data + PASTE_END if bracketed else data


def wheel_bytes(down: bool, column: int, row: int) -> bytes:
    """Return what is sent for a turn of the mouse wheel at a cell, from 0, to a program that asked for the mouse."""
    return f"\x1b[<{65 if down else 64};{column + 1};{row + 1}M".encode()
