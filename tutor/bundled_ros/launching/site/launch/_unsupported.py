"""Stand-ins, which raise when used, for the parts of `launch` and `launch_ros` that this subset lacks."""

from __future__ import annotations

from typing import Any, NoReturn


class NotSupportedError(NotImplementedError):
    """The launch file uses a part of the real launch that this subset lacks."""


def refuse(what: str) -> NoReturn:
    """Raise NotSupportedError for something that only the real launch has; `what` is its full name or a description."""
    raise NotSupportedError(
        f"{what} is not supported by the launch files that run without an installed ROS 2; "
        "it works where ROS 2 is installed and sourced"
    )


class _Refusing(type):
    """The metaclass of the stand-ins. They may appear in annotations and as base classes; any other use raises."""

    _what: str

    def __call__(cls, *args: Any, **kwargs: Any) -> NoReturn:
        refuse(cls._what)

    def __getattr__(cls, name: str) -> NoReturn:
        if name.startswith("__"):  # Python itself probes for optional dunder attributes
            raise AttributeError(name)
        refuse(f"{cls._what}.{name}")

    def __getitem__(cls, item: Any) -> NoReturn:
        refuse(cls._what)

    def __iter__(cls) -> NoReturn:
        refuse(cls._what)


def stand_in(what: str) -> type:
    """Return a class that stands in for the class, function or value of this full name."""
    module, _, name = what.rpartition(".")
    return _Refusing(name, (), {"__module__": module, "__doc__": "Not supported here.", "_what": what})
