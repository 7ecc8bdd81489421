"""Where the output of a process goes."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

NAMED: dict[str, tuple[set[str], set[str]]] = {
    "screen": ({"screen"}, {"screen"}),
    "log": ({"log"}, {"log", "screen"}),
    "both": ({"log", "screen"}, {"log", "screen"}),
    "own_log": ({"own_log", "common_log"}, {"own_log", "common_log"}),
    "full": ({"screen", "log", "own_log", "common_log"}, {"screen", "log", "own_log", "common_log"}),
}
"""For each word the destinations of stdout, and of stderr. `own_log`: a file for each; `common_log`: one for both."""


def destinations(output_config: object) -> dict[str, set[str]]:
    """The destinations of `stdout` and of `stderr`; ValueError where the configuration means nothing."""
    if isinstance(output_config, str):
        if output_config not in NAMED:
            raise ValueError(f'{output_config} is not a valid standard output config i.e. "screen", "log" or "both"')
        stdout, stderr = NAMED[output_config]
        return {"stdout": set(stdout), "stderr": set(stderr)}
    if isinstance(output_config, Mapping):
        return _from_mapping(output_config)
    raise ValueError(f"{output_config} is not a valid output configuration")


def _from_mapping(config: Mapping[object, str | Iterable[str]]) -> dict[str, set[str]]:
    chosen: dict[str, set[str]] = {"stdout": set(), "stderr": set()}
    for source, words in config.items():
        if source not in ("stdout", "stderr", "both"):
            raise ValueError(f'{source} is not a valid output source i.e. "stdout", "stderr" or "both"')
        where = {words} if isinstance(words, str) else set(words)
        for word in where - {"screen", "log", "own_log"}:
            raise ValueError(f'{word} is not a valid output destination i.e. "screen", "log" or "own_log"')
        if source == "both":
            both = {"common_log" if word == "own_log" else word for word in where}
            chosen["stdout"] |= both
            chosen["stderr"] |= both
        else:
            chosen[str(source)] |= where
    return chosen
