"""The engine: runs checks on real processes over real DDS, and streams events to the front end."""

from __future__ import annotations

from tutor.engine.check import run_check

__all__ = ["run_check"]
