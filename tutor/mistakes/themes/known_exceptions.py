"""The tables of known exceptions, in the order in which they are asked."""

from __future__ import annotations

from pathlib import Path

from tutor.mistakes import exceptions
from tutor.mistakes.entry import CATALOGUE

_TABLES = (
    "launch",
    "parameters",
    "callbacks",
    "creation",
    "nodes",
    "attributes",
    "services",
    "messages",
    "logging",
    "lifetime",
    "asynchronous",
    "process",
    "imports",
    "python",
    "syntax",
)

for _name in _TABLES:
    exceptions.add_table(CATALOGUE, Path(exceptions.__file__).parent / f"{_name}.toml")
