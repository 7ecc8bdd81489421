"""Where a launch description comes from."""

from __future__ import annotations

from typing import TYPE_CHECKING

from .launch_context import LaunchContext
from .some_substitutions_type import SomeSubstitutionsType
from .utilities.normalize_to_list_of_substitutions_impl import normalize_to_list_of_substitutions
from .utilities.perform_substitutions_impl import perform_substitutions

if TYPE_CHECKING:
    from .launch_description import LaunchDescription

unreadable: dict[str, Exception] = {}
"""What went wrong with the files that could not be looked at before they run."""


class LaunchDescriptionSource:
    """A launch description, read from `location` at the first need where it is not given."""

    def __init__(
        self,
        launch_description: LaunchDescription | None = None,
        location: SomeSubstitutionsType = "<string>",
        method: str = "unspecified mechanism from a script",
    ) -> None:
        self._description = launch_description
        self._location = normalize_to_list_of_substitutions(location)
        self._expanded_location: str | None = None
        self._method = method

    @property
    def location(self) -> str:
        if self._expanded_location is not None:
            return self._expanded_location
        return " + ".join(str(part) for part in self._location)

    @property
    def method(self) -> str:
        return self._method

    def try_get_launch_description_without_context(self) -> LaunchDescription | None:
        """For a look at it before it runs: None where that takes more than is known then, or it cannot be read."""
        if self._description is not None:
            return self._description
        try:
            location = perform_substitutions(LaunchContext(), self._location)
        except Exception:
            return None
        try:
            return self._get_launch_description(location)
        except Exception as error:
            unreadable[location] = error
            return None

    def get_launch_description(self, context: LaunchContext) -> LaunchDescription:
        if self._expanded_location is None:
            self._expanded_location = perform_substitutions(context, self._location)
        if self._description is None:
            self._description = self._get_launch_description(self._expanded_location)
        return self._description

    def _get_launch_description(self, location: str) -> LaunchDescription:
        raise RuntimeError("this LaunchDescriptionSource holds no launch description and reads none")
