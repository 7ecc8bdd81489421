"""Actions with their conditions, and the event handlers that yield actions."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable, Sequence

from tutor.bundled_ros.launching.launch import errors
from tutor.bundled_ros.launching.launch.base import (
    BaseEventHandler,
    Event,
    LaunchContext,
    LaunchDescriptionEntity,
    SomeEntitiesType,
    SomeSubstitutionsType,
    Substitution,
)
from tutor.bundled_ros.launching.launch.values import (
    normalize_to_list_of_entities,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)


class Action(LaunchDescriptionEntity):
    """An intention to do something, optionally under a condition."""

    def __init__(self, *, condition: Condition | None = None) -> None:
        self._condition = condition
        self._created_at = errors.learner_location()

    @property
    def condition(self) -> Condition | None:
        return self._condition

    def describe(self) -> str:
        return repr(self)

    def get_sub_entities(self) -> Sequence[LaunchDescriptionEntity]:
        """Return the entities nested in this action."""
        return []

    def describe_sub_entities(self) -> Sequence[LaunchDescriptionEntity]:
        return self.get_sub_entities() if self._condition is None else []

    def describe_conditional_sub_entities(self) -> list[tuple[str, Iterable[LaunchDescriptionEntity]]]:
        if self._condition is None:
            return []
        return [(f"Conditionally included by {self.describe()}", self.get_sub_entities())]

    def visit(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity] | None:
        try:
            if self._condition is not None and not self._condition.evaluate(context):
                return None
            try:
                return self.execute(context)
            finally:
                self._report_completion(context)
        except Exception as error:
            errors.note_location(error, self._created_at)
            raise

    def execute(self, context: LaunchContext) -> Sequence[LaunchDescriptionEntity] | None:
        """Carry out the action. The returned entities are visited next."""
        return None

    def _report_completion(self, context: LaunchContext) -> None:
        """Emit ExecutionComplete once the action has finished, if a handler wants it."""
        event = ExecutionComplete(action=self)
        if not context.would_handle_event(event):
            return
        future = self.get_asyncio_future()
        if future is None:
            context.emit_event_sync(event)
        else:
            future.add_done_callback(lambda _: context.emit_event_sync(event))


class ExecutionComplete(Event):
    """The action has finished."""

    name = "launch.events.ExecutionComplete"

    def __init__(self, *, action: Action) -> None:
        self._action = action

    @property
    def action(self) -> Action:
        return self._action


class EventHandler(BaseEventHandler):
    """Yields the same entities whenever an event matches."""

    def __init__(
        self,
        *,
        matcher: Callable[[Event], bool],
        entities: SomeEntitiesType | None = None,
        handle_once: bool = False,
    ) -> None:
        super().__init__(matcher=matcher, handle_once=handle_once)
        self._entities = entities

    @property
    def entities(self) -> SomeEntitiesType | None:
        return self._entities

    def describe(self) -> tuple[str, list[LaunchDescriptionEntity]]:
        description, entities = super().describe()
        if self._entities is not None:
            entities.extend(normalize_to_list_of_entities([self._entities]))
        return description, entities

    def handle(self, event: Event, context: LaunchContext) -> SomeEntitiesType | None:
        super().handle(event, context)
        return self._entities


# --- conditions


class Condition:
    """Decides whether an action is executed."""

    def __init__(self, *, predicate: Callable[[LaunchContext], bool] | None = None) -> None:
        self._predicate = predicate
        self._last_result: bool | None = None

    def describe(self) -> str:
        return repr(self)

    def evaluate(self, context: LaunchContext) -> bool:
        """Return whether the action is executed. Raises if the condition cannot be evaluated."""
        self._last_result = self._predicate(context) if self._predicate is not None else False
        return self._last_result


class InvalidConditionExpressionError(ValueError):
    """A condition's text is neither true nor false."""

    def __init__(
        self, expression: str, unexpanded_expression: Sequence[Substitution], valid_expressions: Sequence[str]
    ) -> None:
        came_from = " + ".join(item.describe() for item in unexpanded_expression)
        super().__init__(
            f"invalid condition expression, expected one of [{', '.join(valid_expressions)}] "
            f"but got '{expression}', expanded from '{came_from}'"
        )


TRUE = ["true", "1"]
FALSE = ["false", "0"]


def evaluate_condition_expression(context: LaunchContext, expression: Sequence[Substitution]) -> bool:
    """Evaluate a condition, ignoring case. Raises InvalidConditionExpressionError for any word not listed above."""
    word = perform_substitutions(context, expression).strip().lower()
    if word in TRUE:
        return True
    if word in FALSE:
        return False
    raise InvalidConditionExpressionError(word, expression, TRUE + FALSE)


class IfCondition(Condition):
    """Executes an action if the expression is true."""

    def __init__(self, predicate_expression: SomeSubstitutionsType) -> None:
        self._expression = normalize_to_list_of_substitutions(predicate_expression)
        super().__init__(predicate=self._is_met)

    def _is_met(self, context: LaunchContext) -> bool:
        return evaluate_condition_expression(context, self._expression)


class UnlessCondition(IfCondition):
    """Executes an action if the expression is false."""

    def _is_met(self, context: LaunchContext) -> bool:
        return not super()._is_met(context)


class LaunchConfigurationEquals(Condition):
    """True if the launch configuration has this value (None: if it is not set)."""

    def __init__(self, launch_configuration_name: str, expected_value: SomeSubstitutionsType | None) -> None:
        warnings.warn(
            f"{type(self).__name__} is deprecated. Use IfCondition with EqualsSubstitution or NotEqualsSubstitution.",
            UserWarning,
            stacklevel=2,
        )
        self._name = launch_configuration_name
        self._expected = None if expected_value is None else normalize_to_list_of_substitutions(expected_value)
        super().__init__(predicate=self._is_met)

    def _is_met(self, context: LaunchContext) -> bool:
        expected = None if self._expected is None else perform_substitutions(context, self._expected)
        value = context.launch_configurations.get(self._name)
        return bool(value == expected)


class LaunchConfigurationNotEquals(LaunchConfigurationEquals):
    """True if the launch configuration has any other value."""

    def _is_met(self, context: LaunchContext) -> bool:
        return not super()._is_met(context)
