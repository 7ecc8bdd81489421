"""What a launch says, and what its processes say: on the screen and in the log files."""

from __future__ import annotations

import logging
import sys

from .files import LogFiles
from .outputs import destinations

__all__ = ["get_logger", "get_output_loggers", "launch_config", "log_launch_config"]

SCREEN_FORMAT = "[{levelname}] [{name}]: {message}"
FILE_FORMAT = "{created:.7f} [{levelname}] [{name}]: {message}"


class _Screen(logging.Handler):
    """Writes to what sys.stdout is at the time; a line of a process comes as it is."""

    def emit(self, record: logging.LogRecord) -> None:
        try:
            text = self.format(record) if record.name not in _process_outputs else record.getMessage()
            encoding = getattr(sys.stdout, "encoding", None) or "utf-8"
            sys.stdout.write(text.encode(encoding, "replace").decode(encoding) + "\n")
            sys.stdout.flush()
        except (OSError, ValueError):
            self.handleError(record)


class LaunchConfig:
    """The level, and where the log files are."""

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
        """The folder of the log files, made at the first need."""
        return str(self.files.folder)


_process_outputs: set[str] = set()
launch_config = LaunchConfig()


def get_logger(name: str | None = None) -> logging.Logger:
    """A logger that writes to the screen and to launch.log, and nowhere else."""
    logger = logging.getLogger(name)
    if launch_config.screen not in logger.handlers:
        logger.propagate = False
        logger.addHandler(launch_config.screen)
        to_file = launch_config.files.handler("launch.log", FILE_FORMAT)
        if to_file is not None:
            logger.addHandler(to_file)
    return logger


def get_output_loggers(process_name: str, output_config: object) -> tuple[logging.Logger, logging.Logger]:
    """The loggers for what a process prints to stdout and to stderr; ValueError for an unknown configuration."""
    loggers = []
    for source, where in destinations(output_config).items():
        logger = logging.getLogger(f"{process_name}-{source}")
        logger.setLevel(logging.INFO)
        logger.propagate = False
        _process_outputs.add(logger.name)
        if "screen" in where:
            logger.addHandler(launch_config.screen)
        files = {
            "log": ("launch.log", "{created:.7f} {message}"),
            "own_log": (f"{process_name}-{source}.log", "{message}"),
            "common_log": (f"{process_name}.log", "{message}"),
        }
        for key, (file_name, form) in files.items():
            handler = launch_config.files.handler(file_name, form) if key in where else None
            if handler is not None:
                logger.addHandler(handler)
        if not logger.handlers:
            logger.addHandler(logging.NullHandler())
        loggers.append(logger)
    return loggers[0], loggers[1]


def log_launch_config(*, logger: logging.Logger) -> None:
    """Say where the log files are, and how much is said."""
    if launch_config.files.any_open:
        logger.info(f"All log files can be found below {launch_config.log_dir}")
    logger.info(f"Default logging verbosity is set to {logging.getLevelName(launch_config.level)}")
