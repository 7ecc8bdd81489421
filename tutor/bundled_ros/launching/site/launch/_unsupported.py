"""What the real `launch` and `launch_ros` have and this subset has not: a stand-in, which refuses when it is used."""

from __future__ import annotations

from typing import Any, NoReturn


class NotSupportedError(NotImplementedError):
    """Something of the real launch that this subset does not have was used."""


def refuse(what: str) -> NoReturn:
    """Raise the one error for a thing that only the real launch has; `what` is its full name, or says what it is."""
    raise NotSupportedError(
        f"{what} is not supported by the launch files that run without an installed ROS 2; "
        "it works where ROS 2 is installed and sourced"
    )


class _Refusing(type):
    """The type of the stand-ins. They can be named in annotations and as a base; all else refuses."""

    _what: str

    def __call__(cls, *args: Any, **kwargs: Any) -> NoReturn:
        refuse(cls._what)

    def __getattr__(cls, name: str) -> NoReturn:
        if name.startswith("__"):  # asked by Python itself, for what it can do without
            raise AttributeError(name)
        refuse(f"{cls._what}.{name}")

    def __getitem__(cls, item: Any) -> NoReturn:
        refuse(cls._what)

    def __iter__(cls) -> NoReturn:
        refuse(cls._what)


def stand_in(what: str) -> type:
    """A class in place of the class, function or value of this full name."""
    module, _, name = what.rpartition(".")
    return _Refusing(name, (), {"__module__": module, "__doc__": "Not supported here.", "_what": what})
