"""The subset of ROS 2's `launch` that the exercises' launch files use, for machines without the real one."""

import sys

from . import _real_names

_real_names.install()

# In order of dependency.
from . import (  # noqa: E402
    actions,
    conditions,
    descriptions,
    event_handlers,
    events,
    launch_description_sources,
    logging,
    substitutions,
    utilities,
)
from ._entities import (  # noqa: E402
    Action,
    Condition,
    Event,
    EventHandler,
    InvalidLaunchFileError,
    LaunchDescriptionEntity,
    SomeEntitiesType,
    SomeEntitiesType_types_tuple,
    SomeSubstitutionsType,
    SomeSubstitutionsType_types_tuple,
    Substitution,
)
from .launch_context import LaunchContext  # noqa: E402
from .launch_description import LaunchDescription  # noqa: E402
from .launch_description_sources import LaunchDescriptionSource  # noqa: E402
from .launch_introspector import LaunchIntrospector  # noqa: E402
from .launch_service import LaunchService  # noqa: E402

__all__ = [
    "Action",
    "Condition",
    "Event",
    "EventHandler",
    "InvalidLaunchFileError",
    "LaunchContext",
    "LaunchDescription",
    "LaunchDescriptionEntity",
    "LaunchDescriptionSource",
    "LaunchIntrospector",
    "LaunchService",
    "SomeEntitiesType",
    "SomeEntitiesType_types_tuple",
    "SomeSubstitutionsType",
    "SomeSubstitutionsType_types_tuple",
    "Substitution",
    "actions",
    "conditions",
    "descriptions",
    "event_handlers",
    "events",
    "launch_description_sources",
    "logging",
    "substitutions",
    "utilities",
]

_real_names.complete(sys.modules[__name__])
