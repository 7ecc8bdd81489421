"""YAML that a user has typed: messages built from it, and what is wrong with it in one line."""

from __future__ import annotations

from typing import Any

from tutor.errors import CommandError


def message_from_yaml(kind: Any, text: str, *, failed: str) -> Any:
    """Build a message of class `kind` from a YAML text; fields that the text does not name keep their defaults.

    Raises CommandError. For a value that does not fit its field, the message is `failed`, with `{}` for the error.
    """
    import yaml

    from tutor.ros.fields import set_fields

    message = kind()
    try:
        set_fields(message, yaml.safe_load(text))
    except yaml.YAMLError as error:
        raise CommandError(f"The passed value is not YAML: {yaml_problem(error)}") from error
    except Exception as error:  # any error of a field's setter describes what is wrong with the value
        raise CommandError(failed.format(error)) from error
    return message


def yaml_problem(error: Exception) -> str:
    """Return the problem that a yaml.YAMLError reports, in one line and without its position."""
    return " ".join(str(getattr(error, "problem", None) or error).split())
