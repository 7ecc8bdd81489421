"""The order of a course's units, and which of them go beyond the course: `lessons/units.yaml`, which it need not have.

    order: [i1, i2]     # the first parts of the exercises' ids, as in i1.3; others follow, by letter and number
    beyond: [b1]        # units that come after all these, and that nobody has to do to have passed the course

Where it names no unit, they come by letter and number.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from tutor.content.fields import Document
from tutor.errors import ContentError

FILE = "units.yaml"


@dataclass(frozen=True, slots=True)
class Units:
    """The units that a course names, by the first part of their exercises' ids."""

    order: tuple[str, ...] = ()
    beyond: tuple[str, ...] = ()

    def key(self, folder: Path) -> tuple[bool, int, str, int, int]:
        """Return the sort key of a lesson's folder, such as i2_10, which comes after i2_9."""
        unit, number = folder.name.split("_")
        letters = unit.rstrip("0123456789")
        listed = self.beyond if unit in self.beyond else self.order
        place = listed.index(unit) if unit in listed else len(listed)
        return unit in self.beyond, place, letters, int(unit.removeprefix(letters)), int(number)

    def is_beyond(self, folder: Path) -> bool:
        """Whether the lesson in this folder belongs to a unit that goes beyond the course."""
        return folder.name.split("_")[0] in self.beyond


def read_units(lessons: Path) -> Units:
    """Read the file, in the folder of the lessons. Raises ContentError."""
    file = lessons / FILE
    try:
        text = file.read_text(encoding="utf-8")
    except FileNotFoundError:
        return Units()
    except (OSError, UnicodeDecodeError) as error:
        raise ContentError(file, f"cannot read it: {error}") from error
    fields = Document(file, text).read()
    units = Units(fields.texts("order", optional=True), fields.texts("beyond", optional=True))
    for unit in units.beyond:
        if unit in units.order:
            raise fields.error("beyond", f"{unit} is in `order` as well")
    fields.done()
    return units
