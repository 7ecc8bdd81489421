"""The engine: runs checks on real processes and real DDS, and streams events to what shows them."""

from __future__ import annotations

from tutor.engine.check import run_check

__all__ = ["run_check"]
