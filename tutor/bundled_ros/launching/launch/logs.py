"""Output of a launch and its processes, on the screen and in log files.

Each launch has its own log folder below ROS_LOG_DIR, ROS_HOME/log or ~/.ros/log.
"""

from __future__ import annotations

import datetime
import logging
import os
import socket
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path

_OUTPUT_CONFIGS: dict[str, tuple[set[str], set[str]]] = {
    "screen": ({"screen"}, {"screen"}),
    "log": ({"log"}, {"log", "screen"}),
    "both": ({"log", "screen"}, {"log", "screen"}),
    "own_log": ({"own_log", "common_log"}, {"own_log", "common_log"}),
    "full": ({"screen", "log", "own_log", "common_log"}, {"screen", "log", "own_log", "common_log"}),
}
"""The destinations of stdout and stderr for each output setting.

`own_log` means one file per stream, `common_log` one file for both.
"""


def destinations(output_config: object) -> dict[str, set[str]]:
    """Return the destinations of `stdout` and `stderr`. Raises ValueError for an invalid configuration."""
    if isinstance(output_config, str):
        if output_config not in _OUTPUT_CONFIGS:
            raise ValueError(f'{output_config} is not a valid standard output config i.e. "screen", "log" or "both"')
        stdout, stderr = _OUTPUT_CONFIGS[output_config]
        return {"stdout": set(stdout), "stderr": set(stderr)}
    if isinstance(output_config, Mapping):
        return _from_mapping(output_config)
    raise ValueError(f"{output_config} is not a valid output configuration")


def _from_mapping(config: Mapping[object, str | Iterable[str]]) -> dict[str, set[str]]:
    chosen: dict[str, set[str]] = {"stdout": set(), "stderr": set()}
    for source, target_names in config.items():
        if source not in ("stdout", "stderr", "both"):
            raise ValueError(f'{source} is not a valid output source i.e. "stdout", "stderr" or "both"')
        targets = {target_names} if isinstance(target_names, str) else set(target_names)
        for word in targets - {"screen", "log", "own_log"}:
            raise ValueError(f'{word} is not a valid output destination i.e. "screen", "log" or "own_log"')
        if source == "both":
            both = {"common_log" if word == "own_log" else word for word in targets}
            chosen["stdout"] |= both
            chosen["stderr"] |= both
        else:
            chosen[str(source)] |= targets
    return chosen


class LogFiles:
    """The log files, opened on first use. If the folder cannot be created, there are none, and output is only shown."""

    def __init__(self) -> None:
        self._folder: Path | None = None
        self._handlers: dict[str, logging.Handler] = {}
        self._unavailable = False

    @property
    def any_open(self) -> bool:
        return bool(self._handlers)

    @property
    def folder(self) -> Path:
        """The folder, created on first use. Raises OSError."""
        if self._folder is None:
            now = datetime.datetime.now().strftime("%Y-%m-%d-%H-%M-%S-%f")
            folder = _log_root() / f"{now}-{socket.gethostname()}-{os.getpid()}"
            folder.mkdir(parents=True)
            self._folder = folder
            _point_latest_to(folder)
        return self._folder

    def handler(self, file_name: str, line_format: str) -> logging.Handler | None:
        """Return the handler that writes to this file in this `{`-style format; None if there are no log files."""
        key = f"{file_name} {line_format}"
        if key not in self._handlers and not self._unavailable:
            try:
                handler = logging.FileHandler(self.folder / file_name, encoding="utf-8", errors="replace")
            except OSError:
                self._unavailable = True
            else:
                handler.setFormatter(logging.Formatter(line_format, style="{"))
                self._handlers[key] = handler
        return self._handlers.get(key)


def _log_root() -> Path:
    if chosen := os.environ.get("ROS_LOG_DIR"):
        return Path(chosen).expanduser()
    return Path(os.environ.get("ROS_HOME") or "~/.ros").expanduser() / "log"


def _point_latest_to(folder: Path) -> None:
    """Update the `latest` link that ROS users know; never replace a real folder of that name."""
    latest = folder.parent / "latest"
    try:
        if latest.is_symlink():
            latest.unlink()
        latest.symlink_to(folder, target_is_directory=True)
    except OSError:
        pass


SCREEN_FORMAT = "[{levelname}] [{name}]: {message}"
FILE_FORMAT = "{created:.7f} [{levelname}] [{name}]: {message}"


class _Screen(logging.Handler):
    """Writes to the current sys.stdout; lines of processes are not formatted again."""

    def emit(self, record: logging.LogRecord) -> None:
        try:
            text = self.format(record) if record.name not in _process_outputs else record.getMessage()
            encoding = getattr(sys.stdout, "encoding", None) or "utf-8"
            sys.stdout.write(text.encode(encoding, "replace").decode(encoding) + "\n")
            sys.stdout.flush()
        except (OSError, ValueError):
            self.handleError(record)


class LaunchConfig:
    """The log level and the log files."""

    def __init__(self) -> None:
        self.files = LogFiles()
        self.screen = _Screen()
        self.screen.setFormatter(logging.Formatter(SCREEN_FORMAT, style="{"))
        self.level = logging.INFO

    @property
    def level(self) -> int:
        return logging.getLogger("launch").getEffectiveLevel()

    @level.setter
    def level(self, level: int) -> None:
        logging.root.setLevel(level)

    @property
    def log_dir(self) -> str:
        """The folder of the log files, created on first use."""
        return str(self.files.folder)


_process_outputs: set[str] = set()
launch_config = LaunchConfig()


def get_logger(name: str | None = None) -> logging.Logger:
    """Return a logger that writes to the screen and launch.log only."""
    logger = logging.getLogger(name)
    if launch_config.screen not in logger.handlers:
        logger.propagate = False
        logger.addHandler(launch_config.screen)
        to_file = launch_config.files.handler("launch.log", FILE_FORMAT)
        if to_file is not None:
            logger.addHandler(to_file)
    return logger


def get_output_loggers(process_name: str, output_config: object) -> tuple[logging.Logger, logging.Logger]:
    """Return the loggers for a process's stdout and stderr. Raises ValueError for an invalid configuration."""
    loggers = []
    for source, targets in destinations(output_config).items():
        logger = logging.getLogger(f"{process_name}-{source}")
        logger.setLevel(logging.INFO)
        logger.propagate = False
        _process_outputs.add(logger.name)
        if "screen" in targets:
            logger.addHandler(launch_config.screen)
        files = {
            "log": ("launch.log", "{created:.7f} {message}"),
            "own_log": (f"{process_name}-{source}.log", "{message}"),
            "common_log": (f"{process_name}.log", "{message}"),
        }
        for key, (file_name, line_format) in files.items():
            handler = launch_config.files.handler(file_name, line_format) if key in targets else None
            if handler is not None:
                logger.addHandler(handler)
        if not logger.handlers:
            logger.addHandler(logging.NullHandler())
        loggers.append(logger)
    return loggers[0], loggers[1]


def log_launch_config(*, logger: logging.Logger) -> None:
    """Log the location of the log files and the verbosity."""
    if launch_config.files.any_open:
        logger.info(f"All log files can be found below {launch_config.log_dir}")
    logger.info(f"Default logging verbosity is set to {logging.getLevelName(launch_config.level)}")
