"""The event loop that runs launch descriptions."""

from __future__ import annotations

import asyncio
import logging
import signal
import sys
from collections.abc import Iterable
from typing import Any

from tutor.bundled_ros.launching.launch import errors
from tutor.bundled_ros.launching.launch.base import Event, LaunchContext, LaunchDescriptionEntity
from tutor.bundled_ros.launching.launch.description import LaunchDescription
from tutor.bundled_ros.launching.launch.events import IncludeLaunchDescription, Shutdown
from tutor.bundled_ros.launching.launch.handlers import OnIncludeLaunchDescription, OnShutdown
from tutor.bundled_ros.launching.launch.logs import get_logger, launch_config, log_launch_config
from tutor.bundled_ros.launching.launch.subprocesses import Process
from tutor.bundled_ros.launching.launch.values import is_a_subclass, visit_all_entities_and_collect_futures

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGQUIT)
KILL_AFTER_S = 2.0
"""How long processes get to end after SIGTERM before SIGKILL, when the launch itself was terminated."""


class LaunchService:
    """Handles one event after another until nothing is left to wait for."""

    def __init__(self, *, argv: Iterable[str] | None = None, noninteractive: bool = False, debug: bool = False) -> None:
        launch_config.level = logging.DEBUG if debug else logging.INFO
        self._logger = get_logger("launch")
        self._context = LaunchContext(argv=argv, noninteractive=noninteractive)
        self._context.register_event_handler(OnIncludeLaunchDescription())
        self._context.register_event_handler(OnShutdown(on_shutdown=self._on_shutdown))
        self._shutting_down = False
        self._interrupted = False
        self._terminated = False
        self._handling = False
        self._signal_pending = False
        self._return_code = 0
        self._task: asyncio.Task[int] | None = None
        self._pending: list[asyncio.Future[Any]] = []

    @property
    def context(self) -> LaunchContext:
        return self._context

    def emit_event(self, event: Event) -> None:
        """Queue an event."""
        self._context.emit_event_sync(event)

    def include_launch_description(self, launch_description: LaunchDescription) -> None:
        """Visit a launch description as soon as the service runs."""
        self.emit_event(IncludeLaunchDescription(launch_description))

    def shutdown(self, force_sync: bool = False) -> None:
        """Shut down, if the service is running."""
        if self._task is not None:
            self._shut_down("LaunchService.shutdown() called")

    def run(self, *, shutdown_when_idle: bool = True) -> int:
        """Run until everything has ended. Returns 0, or 1 after an error of the launch itself, not of its processes."""
        return asyncio.run(self.run_async(shutdown_when_idle=shutdown_when_idle))

    async def run_async(self, *, shutdown_when_idle: bool = True) -> int:
        """Like `run`, in an event loop that is already running."""
        loop = asyncio.get_running_loop()
        self._task = asyncio.current_task()
        self._context._set_asyncio_loop(loop)
        loop.set_exception_handler(self._on_stray_error)
        previous_handlers = {number: signal.signal(number, self._on_signal) for number in SIGNALS}
        log_launch_config(logger=self._logger)
        try:
            await self._handle_events(shutdown_when_idle)
        except asyncio.CancelledError:
            self._logger.error("run task was canceled")
            self._return_code = 1
        finally:
            await self._end_processes()
            for number, handler in previous_handlers.items():
                signal.signal(number, handler)
            self._context._set_asyncio_loop(None)
            self._task = None
        return self._return_code

    async def _handle_events(self, shutdown_when_idle: bool) -> None:
        queue = self._context._event_queue
        while True:
            try:
                if not queue.empty():
                    self._handle(queue.get_nowait())
                    await asyncio.sleep(0)  # let processes and timers run
                elif pending := self._prune_pending():
                    await self._wait(queue, pending)
                elif self._shutting_down:
                    return
                elif shutdown_when_idle:
                    self._shut_down("idle")
                else:
                    await self._wait(queue, [])
            except KeyboardInterrupt:
                continue  # this only interrupted the launch file's code; the signal itself is handled next
            except Exception as error:
                self._report(error)

    def _prune_pending(self) -> list[asyncio.Future[Any]]:
        """Return the futures that are not done yet, and forget the others."""
        context = self._context
        self._pending = [future for future in self._pending if not future.done()]
        context._completion_futures = [future for future in context._completion_futures if not future.done()]
        return [*self._pending, *context._completion_futures]

    async def _wait(self, queue: asyncio.Queue[Event], pending: list[asyncio.Future[Any]]) -> None:
        """Wait for an event, which is handled, or for a pending future, whose exception is raised."""
        event = asyncio.ensure_future(queue.get())
        try:
            done, _ = await asyncio.wait([event, *pending], return_when=asyncio.FIRST_COMPLETED)
        except asyncio.CancelledError:
            event.cancel()
            raise
        if event in done:
            self._handle(event.result())
        else:
            event.cancel()
        for future in done - {event}:
            future.result()

    def _handle(self, event: Event) -> None:
        """Pass the event to all matching handlers, the latest first, and visit the resulting entities."""
        self._handling = True
        try:
            self._dispatch(event)
        except Exception:
            for cancel in self._context._start_cancellers:
                cancel()  # entities that are visited together are started all or none
            raise
        finally:
            self._context._start_cancellers.clear()
            self._handling = False

    def _dispatch(self, event: Event) -> None:
        context = self._context
        self._logger.debug(f"processing event: '{event}'")
        for handler in tuple(context._event_handlers):
            if not handler.matches(event):
                continue
            self._logger.debug(f"processing event: '{event}' ✓ '{handler}'")
            context._push_locals()
            try:
                entities = handler.handle(event, context)
                results = [entities] if entities is None or not isinstance(entities, Iterable) else entities
                for entity in results:
                    if entity is None:
                        continue
                    if not is_a_subclass(entity, LaunchDescriptionEntity):
                        raise RuntimeError(f"expected a LaunchDescriptionEntity from event_handler, got '{entity}'")
                    pairs = visit_all_entities_and_collect_futures(entity, context)
                    self._pending += [future for _, future in pairs]
                    context._start_cancellers.clear()
            finally:
                context._pop_locals()

    # --- shutdown

    def _report(self, error: Exception) -> None:
        message = f"Caught exception in launch (see debug for traceback): {error}"
        self._logger.error(message)
        learner_part = errors.of_learner(error)
        if learner_part is not None:
            print(learner_part, file=sys.stderr, flush=True)
        self._return_code = 1
        self._shut_down(message)

    def _shut_down(self, reason: str, *, due_to_sigint: bool = False) -> None:
        if not self._shutting_down:
            self._context.emit_event_sync(Shutdown(reason=reason, due_to_sigint=due_to_sigint))
        self._shutting_down = True
        self._context._set_is_shutdown(True)

    def _on_shutdown(self, event: Shutdown, context: LaunchContext) -> None:
        self._shutting_down = True
        context._set_is_shutdown(True)

    def _on_signal(self, number: int, frame: object) -> None:
        """Handle a signal between two events. A second one interrupts code of the launch file that does not return."""
        received = signal.Signals(number)
        is_first = received == signal.SIGINT and not self._signal_pending
        self._signal_pending = True
        react = self._on_sigint if received == signal.SIGINT else self._on_sigterm
        self._context.asyncio_loop.call_soon_threadsafe(react, received)
        if self._handling and not is_first:
            raise KeyboardInterrupt

    def _on_sigint(self, number: signal.Signals) -> None:
        self._signal_pending = False
        message = "user interrupted with ctrl-c (SIGINT)"
        if self._interrupted:
            self._logger.warning(f"{message} again, ignoring...")
            return
        self._logger.warning(message)
        self._interrupted = True
        self._shut_down("ctrl-c (SIGINT)", due_to_sigint=True)

    def _on_sigterm(self, number: signal.Signals) -> None:
        self._logger.error(f"user interrupted with ctrl-\\ ({number.name}), terminating...")
        if self._terminated:
            self._signal_processes(signal.SIGKILL)
        elif self._task is not None:
            self._terminated = True
            self._task.cancel()

    def _on_stray_error(self, loop: asyncio.AbstractEventLoop, context: dict[str, Any]) -> None:
        self._return_code = 1
        loop.default_exception_handler(context)

    async def _end_processes(self) -> None:
        """End all remaining processes, which the original leaves behind when it is terminated."""
        for number in (signal.SIGTERM, signal.SIGKILL):
            running = self._signal_processes(number)
            if running:
                ends = [asyncio.ensure_future(process.wait()) for process in running]
                await asyncio.wait(ends, timeout=KILL_AFTER_S)

    def _signal_processes(self, number: signal.Signals) -> list[Process]:
        running = [process for process in self._context._processes if process.returncode is None]
        for process in running:
            try:
                process.send(number)
            except ProcessLookupError:
                continue
        return running
