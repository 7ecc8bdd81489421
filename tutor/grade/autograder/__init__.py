"""What Gradescope and Classroom 50 run, so that each submission is judged and graded as soon as it is handed in.

`make` packs this installation, its course and the teacher's choices into what the system takes. There, `install.py`
installs it, and `python -m tutor.grade.autograder` judges (see `__main__`).
"""

from __future__ import annotations

import base64
import json
from dataclasses import asdict, dataclass
from pathlib import Path

from tutor.errors import StorageError
from tutor.grade.autograder import installation

TIME_LIMITS_MIN = {"gradescope": 10.0, "classroom50": 15.0}
"""How long each system waits for an autograder, unless its settings say otherwise, in minutes."""

_RESERVES_S = {"gradescope": 60.0, "classroom50": 180.0}
"""How much of that goes to what is not judging: Classroom 50 installs ros-tutor for each submission."""

SETTINGS, POINTS, COURSE = "settings.json", "points.toml", "course"
"""The names of files and folders in the bundle: what to judge; if the teacher has them, points and own exercises."""

_FILES = Path(__file__).parent / "files"


@dataclass(frozen=True, slots=True)
class Settings:
    """What an autograder judges. `steps`: whether learners are told the next step of a failure.

    `time_limit_s`: everything must be judged within so many seconds.
    """

    exercises: tuple[str, ...]
    steps: bool
    time_limit_s: float

    def encode(self) -> str:
        """Return the text of the bundle's settings."""
        return json.dumps(asdict(self), indent=1) + "\n"

    @classmethod
    def read(cls, path: Path) -> Settings:
        """Read what `encode` returned. Raises OSError and ValueError."""
        document = json.loads(path.read_text(encoding="utf-8"))
        return cls(tuple(document["exercises"]), document["steps"], document["time_limit_s"])


def time_to_judge_s(system: str, limit_min: float) -> float:
    """Return how many seconds of a system's time limit are left for judging; not above 0 if it is too short."""
    return limit_min * 60 - _RESERVES_S[system]


def make(system: str, settings: Settings, points: Path | None = None, lessons: Path | None = None) -> bytes:
    """Return the file to upload: a zip for Gradescope, a Python script for Classroom 50.

    `points`: a points.toml. `lessons`: a folder with exercises of the teacher's own. Raises StorageError and
    EngineError.
    """
    try:
        bundle = _bundle(settings, points, lessons)
        if system == "gradescope":
            return installation.zip_of(bundle | _read("setup.sh", "run_autograder"))
        return _script(installation.zip_of(bundle))
    except OSError as error:
        raise StorageError.of(f"read {error.filename}", error) from error


def _bundle(settings: Settings, points: Path | None, lessons: Path | None) -> dict[str, bytes]:
    wheel = installation.wheel()
    files = {
        **_read("install.py"),
        SETTINGS: settings.encode().encode(),
        wheel.name: wheel.content,
        "constraints.txt": installation.constraints().encode(),
    }
    if points is not None:
        files[POINTS] = points.read_bytes()
    if lessons is not None:
        for folder in ("lessons", "checks"):
            for path in installation.files_below(lessons / folder):
                files[f"{COURSE}/{path.relative_to(lessons).as_posix()}"] = path.read_bytes()
    return files


def _read(*names: str) -> dict[str, bytes]:
    return {name: (_FILES / name).read_bytes() for name in names}


def _script(bundle: bytes) -> bytes:
    template = (_FILES / "classroom50.py").read_text(encoding="utf-8")
    filled = template.replace('BUNDLE = ""\n', f'BUNDLE = """\n{base64.encodebytes(bundle).decode()}"""\n')
    assert filled != template
    return filled.encode()
