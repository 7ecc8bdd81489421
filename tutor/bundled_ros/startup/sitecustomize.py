"""Makes rclpy's experimental EventsExecutor run callbacks, and says why an interface package is not there.

Python imports this at the start of every program that has this folder in PYTHONPATH. In the wheels, a wait without a
limit ends at `time_point::max()`, which overflows in the C++ library that they were built with: rclpy then waits in a
busy loop, and with its queue of events locked for ever, so that no callback runs. A limit of 30 years has the same
meaning and does not overflow.
"""

from __future__ import annotations

import importlib.util
import os
import sys
from collections.abc import Sequence
from importlib.machinery import ModuleSpec, PathFinder
from types import ModuleType
from typing import Any

MODULE = "rclpy.experimental.events_executor"
FOREVER_S = 1e9


class EventsExecutorFinder:
    """Finds the module of the EventsExecutor as Python does, and has it changed once it has been executed."""

    @staticmethod
    def find_spec(
        fullname: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Return how to import the module; None for any other."""
        spec = PathFinder.find_spec(fullname, path) if fullname == MODULE else None
        if spec is None or spec.loader is None:
            return None
        execute = spec.loader.exec_module

        def execute_and_change(module: ModuleType) -> None:
            execute(module)
            limit_waits(vars(module)["_rclpy"].EventsExecutor)

        vars(spec.loader)["exec_module"] = execute_and_change
        return spec


class UnbuiltPackageFinder:
    """Asked last, for what nothing else has found: adds to Python's message why a package of the workspace is missing.

    `ROS_TUTOR_INTERFACES` names the folder that has a text with the reason for each package that could not be built.
    """

    @staticmethod
    def find_spec(name: str, path: Sequence[str] | None = None, target: ModuleType | None = None) -> ModuleSpec | None:
        """Return None. Raises ModuleNotFoundError, with the reason, for a package that is not built."""
        folder = os.environ.get("ROS_TUTOR_INTERFACES")
        if folder is None or path is not None or not name.isidentifier():
            return None
        try:
            with open(os.path.join(folder, f"{name}.unbuilt"), encoding="utf-8") as file:
                reason = file.read()
        except OSError:
            return None
        error = ModuleNotFoundError(f"No module named {name!r}", name=name)
        error.add_note(f"{name} is in your workspace, but it is not built: {reason}")
        raise error


def limit_waits(executor_class: Any) -> None:
    """Give each wait of an EventsExecutor that has no limit one of 30 years."""
    once, once_until, until = (
        executor_class.spin_once,
        executor_class.spin_once_until_future_complete,
        executor_class.spin_until_future_complete,
    )

    def spin(self: Any) -> None:
        from rclpy.task import Future

        until(self, Future(), FOREVER_S)  # a future that nothing completes

    def spin_once(self: Any, timeout_sec: float | None = None) -> None:
        once(self, FOREVER_S if timeout_sec is None else timeout_sec)

    def spin_once_until_future_complete(self: Any, future: Any, timeout_sec: float | None = None) -> None:
        once_until(self, future, FOREVER_S if timeout_sec is None else timeout_sec)

    def spin_until_future_complete(self: Any, future: Any, timeout_sec: float | None = None) -> None:
        until(self, future, FOREVER_S if timeout_sec is None else timeout_sec)

    for method in (spin, spin_once, spin_once_until_future_complete, spin_until_future_complete):
        setattr(executor_class, method.__name__, method)


def _run_next() -> None:
    """Run the `sitecustomize` that Python would have found without this one."""
    here = os.path.dirname(os.path.abspath(__file__))
    spec = PathFinder.find_spec("sitecustomize", [entry for entry in sys.path if os.path.abspath(entry) != here])
    if spec is not None and spec.loader is not None:
        module = importlib.util.module_from_spec(spec)
        sys.modules["sitecustomize"] = module
        spec.loader.exec_module(module)


if __name__ == "sitecustomize":
    sys.meta_path.insert(0, EventsExecutorFinder)
    sys.meta_path.append(UnbuiltPackageFinder)
    _run_next()
