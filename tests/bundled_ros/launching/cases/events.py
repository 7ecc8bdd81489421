"""Processes, events, timers and shutdown, and their order."""

from tests.bundled_ros.launching.case import Case


def echo(text: str, options: str = "output='screen'") -> str:
    """Return an ExecuteProcess action that prints the text."""
    return f"ExecuteProcess(cmd=['echo', '{text}'], {options})"


WAITER = "Node(package='demo', executable='waiter', output='screen')"

CASES = (
    Case(
        id="one-is-wrong-nothing-is-started",
        source="launch 3.4.11: processes visited together with an action that raises are not started",
        actions="ExecuteProcess(cmd=['echo', 'one'], output='screen'), TimerAction(period=0.01, actions=["
        "LogInfo(msg='timer')]), Node(package='nowhere', executable='talker')",
        log=("[ERROR] [launch]: Caught exception in launch (see debug for traceback): *package 'nowhere' not found*",),
        absent=("process started", "timer"),
        code=1,
    ),
    Case(
        id="visited-in-order",
        source="launch: doc/source/architecture.rst, LaunchDescription; test_launch_description.py",
        actions="LogInfo(msg='1'), GroupAction([LogInfo(msg='2'), LogInfo(msg='3')]), "
        "LaunchDescription([LogInfo(msg='4')]), "
        "LogInfo(msg='5')",
        log=tuple(f"[INFO] [launch.user]: {number}" for number in range(1, 6)),
    ),
    Case(
        id="messages-of-a-process",
        source="launch: actions/execute_local.py, __execute_process",
        actions=echo("hello"),
        log=("[INFO] [echo-1]: process started with pid [N]", "[INFO] [echo-1]: process has finished cleanly [pid N]"),
        printed={"echo-1": ("hello",)},
    ),
    Case(
        id="process-dies",
        source="launch: actions/execute_local.py, __execute_process",
        actions="ExecuteProcess(cmd=['sh', '-c', 'echo last words; exit 7'], output='screen')",
        log=("[ERROR] [sh-1]: process has died [pid N, exit code 7, cmd 'sh -c echo last words; exit 7'].",),
        printed={"sh-1": ("last words",)},
    ),
    Case(
        id="process-killed",
        source="launch: actions/execute_local.py, __execute_process (the return code of asyncio: minus the signal)",
        actions="ExecuteProcess(cmd=['sh', '-c', 'kill -9 $$'])",
        log=("[ERROR] [sh-1]: process has died [pid N, exit code -9, cmd 'sh -c kill -9 $$'].",),
    ),
    Case(
        id="process-cannot-start",
        source="launch: actions/execute_local.py, __execute_process",
        actions="ExecuteProcess(cmd=['/no/such/program']), LogInfo(msg='goes on')",
        log=("[INFO] [launch.user]: goes on", "[ERROR] [program-1]: exception occurred while executing process:"),
        absent=("process started",),
    ),
    Case(
        id="output-log-shows-stderr-only",
        source="launch: logging/__init__.py, get_output_loggers; actions/execute_local.py, docstring of output",
        actions="ExecuteProcess(cmd=['sh', '-c', 'echo out; echo err >&2'])",
        printed={"sh-1": ("err",)},
    ),
    Case(
        id="output-by-stream",
        source="launch: test_execute_local.py, test_execute_process_with_output_dictionary",
        actions="ExecuteProcess(cmd=['sh', '-c', 'echo out; echo err >&2'], output={'stdout': 'screen', "
        "'stderr': 'log'})",
        printed={"sh-1": ("out",)},
    ),
    Case(
        id="output-own-log",
        source="launch: logging/__init__.py, _normalize_output_configuration; test_logging.py",
        actions="ExecuteProcess(cmd=['sh', '-c', 'echo out; echo err >&2'], output='own_log')",
        log=("[INFO] [sh-1]: process has finished cleanly [pid N]",),
        printed={},
    ),
    Case(
        id="output-unknown",
        source="launch: logging/__init__.py, _normalize_output_configuration; test_logging.py",
        actions="ExecuteProcess(cmd=['true'], output='nowhere')",
        log=(
            "[ERROR] [launch]: Caught exception in launch (see debug for traceback): nowhere is not a valid "
            "standard output "
            'config i.e. "screen", "log" or "both"',
        ),
        code=1,
    ),
    Case(
        id="output-overridden",
        source="launch: actions/execute_local.py, docstring of output (OVERRIDE_LAUNCH_PROCESS_OUTPUT)",
        environment={"OVERRIDE_LAUNCH_PROCESS_OUTPUT": "both"},
        actions=echo("shown", "output='log'"),
        printed={"echo-1": ("shown",)},
    ),
    Case(
        id="last-line-without-an-end",
        source="launch: actions/execute_local.py, __flush_buffers",
        actions="ExecuteProcess(cmd=['printf', 'one\\ntwo'], output='screen')",
        printed={"printf-1": ("one", "two")},
    ),
    Case(
        id="cwd-and-log-cmd",
        source="launch: descriptions/executable.py, prepare; actions/execute_local.py, log_cmd",
        actions="ExecuteProcess(cmd=['pwd'], cwd=[ThisLaunchFileDir(), '/prefix'], output='screen', log_cmd=True)",
        log=("[INFO] [pwd-1]: process details: cmd='pwd', cwd='$PREFIX', custom_env?=True",),
        printed={"pwd-1": ("$PREFIX",)},
    ),
    Case(
        id="emulate-tty",
        source="launch: test_emulate_tty.py",
        actions="ExecuteProcess(cmd=['sh', '-c', 'test -t 1 && test -t 2 && echo terminal'], output='screen', "
        "emulate_tty=True), ExecuteProcess(cmd=['sh', '-c', 'test -t 1 || echo none'], output='screen')",
        printed={"sh-1": ("terminal",), "sh-2": ("none",)},
    ),
    Case(
        id="on-process-start",
        source="launch: test_on_process_start.py; docs.ros.org, Using event handlers",
        before="p = ExecuteProcess(cmd=['sleep', '0.2'])\n",
        actions="RegisterEventHandler(OnProcessStart(target_action=p, on_start=[LogInfo(msg='started'), "
        + echo("after")
        + "]"
        ")), p",
        log=(
            "[INFO] [sleep-1]: process started with pid [N]",
            "[INFO] [launch.user]: started",
            "[INFO] [echo-2]: process started with pid [N]",
            "[INFO] [echo-2]: process has finished cleanly [pid N]",
            "[INFO] [sleep-1]: process has finished cleanly [pid N]",
        ),
        printed={"echo-2": ("after",)},
    ),
    Case(
        id="on-process-exit-chain",
        source="launch: test_on_process_exit.py; docs.ros.org, Using event handlers",
        before="a = ExecuteProcess(cmd=['true'])\nb = ExecuteProcess(cmd=['sh', '-c', 'exit 0'])\n",
        actions="a, RegisterEventHandler(OnProcessExit(target_action=a, on_exit=[LogInfo(msg='a is over'), b])), "
        "RegisterEventHandler(OnProcessExit(target_action=b, on_exit=LogInfo(msg='b is over')))",
        log=(
            "[INFO] [true-1]: process started with pid [N]",
            "[INFO] [true-1]: process has finished cleanly [pid N]",
            "[INFO] [launch.user]: a is over",
            "[INFO] [sh-2]: process started with pid [N]",
            "[INFO] [sh-2]: process has finished cleanly [pid N]",
            "[INFO] [launch.user]: b is over",
        ),
    ),
    Case(
        id="on-process-exit-function",
        source="launch: test_on_process_exit.py, test_handle_callable",
        before="def over(event, context):\n    return LogInfo(msg=f'{event.process_name} {event.returncode} "
        "{event.cmd[0]}')\n",
        actions="RegisterEventHandler(OnProcessExit(on_exit=over)), ExecuteProcess(cmd=['sh', '-c', 'exit 4'])",
        log=("[INFO] [launch.user]: sh-1 4 sh",),
    ),
    Case(
        id="on-process-exit-by-matcher",
        source="launch: test_on_process_exit.py, test_callable_target",
        actions="RegisterEventHandler(OnProcessExit(target_action=lambda action: 'false' in action.cmd, "
        "on_exit=[LogInfo(msg='the false one')])), ExecuteProcess(cmd=['true']), ExecuteProcess(cmd=['false'])",
        log=(
            "[ERROR] [false-2]: process has died [pid N, exit code 1, cmd 'false'].",
            "[INFO] [launch.user]: the false one",
        ),
    ),
    Case(
        id="on-process-io",
        source="launch: test_on_process_io.py; docs.ros.org, Using event handlers",
        before="def printed(event):\n    return LogInfo(msg='it said ' + event.text.decode().strip())\n",
        actions="RegisterEventHandler(OnProcessIO(on_stdout=printed)), " + echo("hello"),
        log=("[INFO] [launch.user]: it said hello",),
        printed={"echo-1": ("hello",)},
    ),
    Case(
        id="on-execution-complete",
        source="launch: test_on_execution_complete.py; docs.ros.org, Using event handlers",
        before="p = ExecuteProcess(cmd=['true'])\n",
        actions="RegisterEventHandler(OnExecutionComplete(target_action=p, "
        "on_completion=[LogInfo(msg='complete')])), p",
        log=("[INFO] [true-1]: process has finished cleanly [pid N]", "[INFO] [launch.user]: complete"),
    ),
    Case(
        id="handlers-last-registered-first",
        source="launch: launch_context.py, register_event_handler (prepended)",
        before="p = ExecuteProcess(cmd=['true'])\n",
        actions="p, "
        + ", ".join(
            f"RegisterEventHandler(OnProcessExit(target_action=p, on_exit=[LogInfo(msg='{word}')]))"
            for word in ("one", "two")
        ),
        log=("[INFO] [launch.user]: two", "[INFO] [launch.user]: one"),
    ),
    Case(
        id="handler-once",
        source="launch: test_on_process_exit.py, test_handle_once; event_handler.py",
        actions="RegisterEventHandler(OnProcessExit(handle_once=True, on_exit=lambda event, context: "
        "LogInfo(msg='one over'))), "
        "ExecuteProcess(cmd=['true']), ExecuteProcess(cmd=['true'])",
        log=("[INFO] [launch.user]: one over",),
    ),
    Case(
        id="on-exit-of-a-process",
        source="launch: test_execute_process.py, test_execute_process_with_on_exit_behavior",
        actions="ExecuteProcess(cmd=['true'], on_exit=[LogInfo(msg='listed')]), "
        "ExecuteProcess(cmd=['false'], on_exit=lambda event, context: [LogInfo(msg=f'called {event.returncode}')])",
        log=("[INFO] [launch.user]: called 1",),
    ),
    Case(
        id="required-process",
        source="launch: actions/shutdown_action.py, execute; launch_ros: test_node.py, test_launch_required_node",
        before=f"w = {WAITER}\n",
        actions="w, RegisterEventHandler(OnProcessIO(target_action=w, on_stdout=lambda event: ExecuteProcess("
        "cmd=['false'], on_exit=[Shutdown(reason='it is over')]) if b'ready' in event.text else None)), "
        "RegisterEventHandler(OnShutdown(on_shutdown=lambda event, context: LogInfo(msg='reason: ' + event.reason)))",
        log=(
            "[ERROR] [false-2]: process has died [pid N, exit code 1, cmd 'false'].",
            "[INFO] [launch]: process[false-2] was required: shutting down launched system",
            "[INFO] [launch.user]: reason: it is over",
            "[INFO] [waiter-1]: sending signal 'SIGINT' to process[waiter-1]",
            "[INFO] [waiter-1]: process has finished cleanly [pid N]",
        ),
        printed={"waiter-1": ("ready", "interrupted")},
    ),
    Case(
        id="shutdown-by-a-timer",
        source="launch: test_timer_action.py, test_shutdown_preempts_timers; test_execute_process.py, ..._shutdown",
        actions=f"{WAITER}, TimerAction(period=0.6, actions=[LogInfo(msg='time is over'), Shutdown()]), "
        "TimerAction(period=30.0, actions=[LogInfo(msg='never')])",
        log=(
            "[INFO] [launch.user]: time is over",
            "[INFO] [waiter-1]: sending signal 'SIGINT' to process[waiter-1]",
            "[INFO] [waiter-1]: process has finished cleanly [pid N]",
        ),
        absent=("never",),
    ),
    Case(
        id="timers-in-order",
        source="launch: test_timer_action.py, test_multiple_launch_with_timers; actions/timer_action.py",
        actions="TimerAction(period=0.3, actions=[LogInfo(msg='late'), TimerAction(period=0.1, "
        "actions=[LogInfo(msg='last')])]"
        "), TimerAction(period=LaunchConfiguration('p', default='0.05'), actions=[LogInfo(msg='early')]), "
        "LogInfo(msg='now')",
        log=tuple(f"[INFO] [launch.user]: {word}" for word in ("now", "early", "late", "last")),
    ),
    Case(
        id="timer-sees-what-was-set-before",
        source="launch: actions/timer_action.py, execute (locals and, since 3.4.5, launch configurations are kept)",
        actions="SetLaunchConfiguration('x', '1'), TimerAction(period=0.05, actions=[LogInfo(msg=['x is ', "
        "LaunchConfiguration('x')]), LogInfo(msg=ThisLaunchFileDir())]), SetLaunchConfiguration('x', '2')",
        log=("[INFO] [launch.user]: x is 1", "[INFO] [launch.user]: $DIR"),
    ),
    Case(
        id="on-shutdown-when-idle",
        source="launch: launch_service.py, run_async (shutdown_when_idle); test_on_shutdown.py",
        actions="RegisterEventHandler(OnShutdown(on_shutdown=[LogInfo(msg=['because ', "
        "LocalSubstitution('event.reason')])]))," + echo("hello"),
        log=("[INFO] [echo-1]: process has finished cleanly [pid N]", "[INFO] [launch.user]: because idle"),
        printed={"echo-1": ("hello",)},
    ),
    Case(
        id="nothing-starts-after-shutdown",
        source="launch: actions/execute_local.py, execute (context.is_shutdown)",
        actions="RegisterEventHandler(OnShutdown(on_shutdown=[ExecuteProcess(cmd=['echo', 'too late'], "
        "output='screen')])), "
        "LogInfo(msg='hello')",
        log=("[INFO] [launch.user]: hello",),
        absent=("process started", "too late"),
    ),
    Case(
        id="shutdown-of-one-process",
        source="launch: actions/execute_local.py, docstring (ShutdownProcess); events/process/shutdown_process.py",
        before=f"w = {WAITER}\n",
        actions="w, RegisterEventHandler(OnProcessIO(target_action=w, on_stdout=lambda event: "
        "EmitEvent(event=ShutdownProcess("
        "process_matcher=matches_action(w))) if b'ready' in event.text else None)), "
        "RegisterEventHandler(OnProcessExit(target_action=w, on_exit=[LogInfo(msg='gone')]))",
        log=(
            "[INFO] [waiter-1]: sending signal 'SIGINT' to process[waiter-1]",
            "[INFO] [waiter-1]: process has finished cleanly [pid N]",
            "[INFO] [launch.user]: gone",
        ),
        printed={"waiter-1": ("ready", "interrupted")},
    ),
    Case(
        id="escalation-to-sigterm",
        source="launch: test_execute_process.py, test_execute_process_shutdown; actions/execute_local.py, "
        "sigterm_timeout",
        interrupt_at="ready",
        actions="Node(package='demo', executable='stubborn', output='screen', sigterm_timeout='0.3')",
        log=(
            "[WARNING] [launch]: user interrupted with ctrl-c (SIGINT)",
            "[INFO] [stubborn-1]: sending signal 'SIGINT' to process[stubborn-1]",
            "[ERROR] [stubborn-1]: process[stubborn-1] failed to terminate '0.3' seconds after receiving 'SIGINT', "
            "escalating to 'SIGTERM'",
            "[INFO] [stubborn-1]: sending signal 'SIGTERM' to process[stubborn-1]",
            "[INFO] [stubborn-1]: process has finished cleanly [pid N]",
        ),
        printed={"stubborn-1": ("ready", "terminated")},
    ),
    Case(
        id="escalation-to-sigkill",
        source="launch: actions/execute_local.py, __get_shutdown_timer_actions; configurations sigterm_timeout, "
        "sigkill_timeout",
        interrupt_at="ready",
        arguments=("sigterm_timeout:=0.2", "sigkill_timeout:=0.3"),
        actions="Node(package='demo', executable='immortal', output='screen')",
        log=(
            "[ERROR] [immortal-1]: process[immortal-1] failed to terminate '0.2' seconds after receiving 'SIGINT', "
            "escalating to 'SIGTERM'",
            "[INFO] [immortal-1]: sending signal 'SIGTERM' to process[immortal-1]",
            "[ERROR] [immortal-1]: process[immortal-1] failed to terminate '0.5' seconds after receiving 'SIGTERM', "
            "escalating to 'SIGKILL'",
            "[INFO] [immortal-1]: sending signal 'SIGKILL' to process[immortal-1]",
            "[ERROR] [immortal-1]: process has died [pid N, exit code -9, cmd '$PREFIX/lib/demo/immortal --ros-args'].",
        ),
    ),
    Case(
        id="ctrl-c-ends-all",
        source="launch: launch_service.py, _on_sigint; actions/execute_local.py, __on_shutdown (noninteractive)",
        interrupt_at="ready",
        actions=f"RegisterEventHandler(OnShutdown(on_shutdown=lambda event, context: LogInfo(msg='because ' + "
        f"event.reason))), "
        f"{WAITER}, RegisterEventHandler(OnProcessExit(on_exit=lambda event, context: LogInfo(msg='exit')))",
        log=(
            "[INFO] [launch.user]: because ctrl-c (SIGINT)",
            "[INFO] [waiter-1]: process has finished cleanly [pid N]",
            "[INFO] [launch.user]: exit",
        ),
        printed={"waiter-1": ("ready", "interrupted")},
    ),
    Case(
        id="respawn",
        source="launch: test_execute_process.py, test_execute_process_with_respawn_max_retries",
        actions="ExecuteProcess(cmd=['echo', 'again'], output='screen', respawn=True, respawn_delay=0.05, "
        "respawn_max_retries=2)",
        log=("[INFO] [echo-1]: process started with pid [N]", "[INFO] [echo-1]: process has finished cleanly [pid N]")
        * 3,
        printed={"echo-1": ("again", "again", "again")},
    ),
    Case(
        id="opaque-function",
        source="launch: actions/opaque_function.py, class docstring; docs.ros.org, Using substitutions",
        arguments=("count:=2",),
        before="def several(context, word, *, end):\n    count = int(LaunchConfiguration('count').perform(context))\n"
        "    return [LogInfo(msg=f'{word} {i}{end}') for i in range(count)]\n",
        actions="OpaqueFunction(function=several, args=['number'], kwargs={'end': '!'}), LogInfo(msg='after')",
        log=("[INFO] [launch.user]: number 0!", "[INFO] [launch.user]: number 1!", "[INFO] [launch.user]: after"),
    ),
    Case(
        id="opaque-coroutine",
        source="launch: actions/opaque_coroutine.py, execute and __on_shutdown",
        before="import asyncio\nimport launch\n"
        "async def late(context, word):\n    await asyncio.sleep(0.01)\n    LogInfo(msg=word).execute(context)\n"
        "async def cancelled(*, end):\n    try:\n        await asyncio.Event().wait()\n    finally:\n        end()\n"
        "def end():\n    launch.logging.get_logger('launch.user').info('cancelled')\n",
        actions="OpaqueCoroutine(coroutine=late, args=['late']), LogInfo(msg='first'), "
        "OpaqueCoroutine(coroutine=cancelled, kwargs={'end': end}, ignore_context=True), "
        "TimerAction(period=0.2, actions=[Shutdown()])",
        log=tuple(f"[INFO] [launch.user]: {word}" for word in ("first", "late", "cancelled")),
    ),
    Case(
        id="executed-twice",
        source="launch: actions/execute_local.py, execute (executed more than once)",
        before="p = ExecuteProcess(cmd=['true'])\n",
        actions="p, p",
        log=(
            "[ERROR] [launch]: Caught exception in launch (see debug for traceback): "
            "ExecuteLocal action 'true-2': executed more than once: *",
        ),
        code=1,
    ),
    Case(
        id="error-ends-what-runs",
        source="launch: launch_service.py, run_async (an exception shuts down)",
        before=f"w = {WAITER}\n",
        actions="w, RegisterEventHandler(OnProcessIO(target_action=w, on_stdout=lambda event: 1 / 0 if b'ready' "
        "in event.text "
        "else None))",
        log=(
            "[ERROR] [launch]: Caught exception in launch (see debug for traceback): division by zero",
            "[INFO] [waiter-1]: sending signal 'SIGINT' to process[waiter-1]",
            "[INFO] [waiter-1]: process has finished cleanly [pid N]",
        ),
        code=1,
    ),
    Case(
        id="error-in-the-file",
        source="launch: invalid_launch_file_error.py; test_invalid_launch_file_error.py",
        before="undefined_name\n",
        actions="",
        log=(
            "[ERROR] [launch]: Caught exception in launch (see debug for traceback): "
            "Caught multiple exceptions when trying to load file of format [py]:",
        ),
        code=1,
    ),
)
