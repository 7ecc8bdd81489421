"""Rewrite what a publisher sends, and when: the message, the timer and the timer's callback."""

from __future__ import annotations

import ast
from collections.abc import Iterator

from tutor.judge.edits import Edit, insert_above, insert_after, remove_statement, replace_node, replace_statement
from tutor.judge.rewriting.node import NodeFile, argument, rewrite_function
from tutor.judge.source import Function, called_name, calls_in


def send_data(file: NodeFile, code: str, *, message_class: str = "") -> list[Edit]:
    """Set the `data` of the message that the timer's callback publishes to this code.

    `message_class`: leave messages of other classes alone.
    """
    if file.timer_callback is None:
        return []
    within = file.reachable_from(file.timer_callback)
    found = list(_data_expressions(file, within))
    if message_class:
        found = [each for each in found if _may_belong_to(file, each, message_class)]
    if found:
        return [_replace_data(file, expression, code) for expression in found]
    sent = [each for each in file.calls("publish") if file.function_around(each) in within and each.args]
    if not sent or not isinstance(sent[0].args[0], ast.Name | ast.Attribute):
        return []
    return [insert_above(file.statement(sent[0]).lineno, f"{ast.unparse(sent[0].args[0])}.data = {code}")]


def published_data(file: NodeFile) -> ast.expr | None:
    """The expression that the timer's callback puts into the message's `data`."""
    within = file.reachable_from(file.timer_callback) if file.timer_callback is not None else []
    return next(_data_expressions(file, within), None)


def _data_expressions(file: NodeFile, within: list[Function]) -> Iterator[ast.expr]:
    for node in ast.walk(file.tree):
        if file.function_around(node) not in within:
            continue
        match node:
            case ast.Assign(targets=[ast.Attribute(attr="data")], value=value):
                yield value
            case ast.Call(keywords=[ast.keyword(arg="data", value=value)]) if called_name(node) == file.message_class:
                yield value


def _may_belong_to(file: NodeFile, data: ast.expr, message_class: str) -> bool:
    """Whether this value of `message.data` may belong to a message of this class, as far as its function shows."""
    statement, function = file.statement(data), file.function_around(data)
    if not isinstance(statement, ast.Assign) or not isinstance(statement.targets[0], ast.Attribute):
        return True
    message = ast.unparse(statement.targets[0].value)
    made = [
        called_name(each.value)
        for each in (ast.walk(function) if function is not None else ())
        if isinstance(each, ast.Assign) and isinstance(each.value, ast.Call)
        if ast.unparse(each.targets[0]) == message
    ]
    return not any(name[:1].isupper() and name != message_class for name in made)


def _replace_data(file: NodeFile, expression: ast.expr, code: str) -> Edit:
    """Replace an expression: an assignment is rewritten as a whole, in any other statement the rest stays as it is."""
    statement = file.statement(expression)
    if isinstance(statement, ast.Assign) and statement.value is expression:
        target = ast.unparse(statement.targets[0])
        return replace_statement(statement, f"{target} = {code}")
    return replace_node(file.text, expression, code)


def pause_while_off(file: NodeFile, enabled: str) -> list[Edit]:
    """Let the timer's callback return at once while a parameter is false; without a timer, only skip publishing."""
    if file.first_timer is not None and file.timer_callback is not None and file.timer_callback is not file.setup:
        return file.prepend_to(file.timer_callback, f"if not {file.value(enabled)}:\n    return")
    return [
        replace_statement(each, f"if {file.value(enabled)}:\n    {ast.unparse(each)}")
        for each in _publish_statements(file)
    ]


def log_value(file: NodeFile, parameter: str) -> list[Edit]:
    """Log a parameter's value whenever a message is published."""
    code = f"{file.name}.get_logger().info(str({file.value(parameter)}))"
    return [insert_above(each.lineno, code) for each in _publish_statements(file)[:1]]


def _publish_statements(file: NodeFile) -> list[ast.stmt]:
    """The statements that publish: those reached from the timer's callback, if there is one, else all."""
    within = file.reachable_from(file.timer_callback) if file.timer_callback is not None else []
    sent = [each for each in file.calls("publish") if not within or file.function_around(each) in within]
    return [file.statement(each) for each in sent]


def prefixed_text(file: NodeFile, prefix: str) -> str:
    """The code of a text that starts with a parameter's value, followed by the callback's counter, if any."""
    counter = _counter(file)
    return f"f'{{{_double_quoted(file.value(prefix))}}} {{{counter}}}'" if counter else file.value(prefix)


def _counter(file: NodeFile) -> str:
    """The counter that the timer's callback increments, such as "self.count"; empty if there is none."""
    counted = [
        ast.unparse(node.target)
        for function in (file.reachable_from(file.timer_callback) if file.timer_callback is not None else [])
        for node in ast.walk(function)
        if isinstance(node, ast.AugAssign) and isinstance(node.op, ast.Add) and isinstance(node.value, ast.Constant)
    ]
    return next(iter(counted), "")


def whole_timer_callback(file: NodeFile, data: str, *, enabled: str = "", log: str = "") -> list[Edit]:
    """Rewrite the timer's whole callback: it sends one message per call, and none while a parameter is false.

    `data`: the code of the message's data. `enabled`, `log`: the parameters that switch publishing off, and that are
    logged with each message.
    """
    if file.timer_callback is None or not file.publisher or not file.message_class or file.timer_callback is file.setup:
        return []
    body = _callback_body(file, file.publisher, file.message_class, data, enabled, log)
    return [rewrite_function(file.timer_callback, body)]


def _callback_body(file: NodeFile, publisher: str, message_class: str, data: str, enabled: str, log: str) -> str:
    """The code of a timer callback's body (see `whole_timer_callback`)."""
    counter, body = _counter(file), file.timer_callback.body if file.timer_callback is not None else []
    lines = [
        *(ast.unparse(each) for each in body if isinstance(each, ast.Global | ast.Nonlocal)),
        *([f"if not {file.value(enabled)}:", "    return"] if enabled else []),
        f"message = {message_class}()",
        f"message.data = {data}",
        f"{publisher}.publish(message)",
        *(
            [f"{file.name}.get_logger().info(f'{{{_double_quoted(file.value(log))}}}: {{message.data}}')"]
            if log
            else []
        ),
        *([f"{counter} += 1"] if counter else []),
    ]
    return "\n".join(lines)


def whole_publishing(
    file: NodeFile, topic: str, type_name: str, data: str, rate: str, *, enabled: str = "", log: str = ""
) -> list[Edit]:
    """Fix publisher, timer and callback as a whole: add what is missing, and rewrite the callback.

    `type_name` is like "std_msgs/msg/String", and `data` is code. `rate`, `enabled` and `log` are names of parameters;
    they are only used if they occur in the file.
    """
    constants = {each.value for each in ast.walk(file.tree) if isinstance(each, ast.Constant)}
    enabled, log = enabled if enabled in constants else "", log if log in constants else ""
    period = f"1.0 / {file.value(rate)}" if rate in constants else "1.0"
    package, _, name = type_name.partition("/msg/")
    own, edits = file.import_name(name, f"{package}.msg")
    made = file.calls("create_publisher", "create_lifecycle_publisher")
    existing = next((each for each in made if file.assigned_to(each)), None)
    publisher = file.assigned_to(existing) if existing is not None else f"{file.owner}.publisher"
    create = f"{file.name}.create_publisher({own}, {topic!r}, 10)"
    topic_arg = argument(existing, 1, "topic") if existing is not None else None
    present_topic = str(topic_arg.value) if isinstance(topic_arg, ast.Constant) else ""
    if existing is not None and (file.message_class, present_topic.lstrip("/")) != (own, topic.lstrip("/")):
        edits.append(replace_node(file.text, existing, create))
    missing = [f"{publisher} = {create}"] if existing is None else []
    body = _callback_body(file, publisher, own, data, enabled, log)
    tick = file.timer_callback if file.timer_callback is not file.setup and file.timer_callback is not None else None
    in_class = file.setup is not None and file.class_of(file.setup) is not None
    method = tick.name if tick is not None else "timer_callback"
    indented = "\n".join(f"    {line}" for line in body.splitlines())
    if tick is not None:
        edits.append(rewrite_function(tick, body))
    elif in_class:
        edits += file.new_method(f"def {method}(self):\n{indented}")
    else:
        missing.append(f"def {method}():\n{indented}\n")
    if not file.timers or tick is None:
        callback = f"{'self.' if in_class else ''}{method}"
        missing.append(f"{file.owner}.timer = {file.name}.create_timer({period}, {callback})")
    if not in_class and not any(called_name(each).startswith("spin") for each in calls_in(file.tree)):
        missing.append(f"rclpy.spin({file.name})")
    return [*edits, *(file.append_to_setup("\n".join(missing)) if missing else [])]


def use_one_type(file: NodeFile, topic: str, type_name: str) -> list[Edit]:
    """Move publishers of any other type on a topic to a topic of their own; let subscriptions expect the right type."""
    own, _ = file.import_name(type_name.rpartition("/")[2], type_name.partition("/")[0] + ".msg")
    edits = []
    for call in file.calls("create_publisher"):
        kind, name = argument(call, 0, "msg_type"), argument(call, 1, "topic")
        if kind is None or name is None or ast.unparse(kind) == own:
            continue
        if _topic_text(file, name) != topic.lstrip("/"):
            continue
        if isinstance(kind, ast.Attribute) and isinstance(name, ast.Attribute):
            edits += _name_topics_of_subclasses(file, kind.attr, own, name.attr, topic)
        else:
            edits.append(replace_node(file.text, name, repr(f"{topic}_{ast.unparse(kind).lower()}")))
    for call in file.calls("create_subscription"):
        kind, name = argument(call, 0, "msg_type"), argument(call, 1, "topic")
        if kind is not None and ast.unparse(kind) != own and _topic_text(file, name) == topic.lstrip("/"):
            edits.append(replace_node(file.text, kind, own))
    return edits


def _name_topics_of_subclasses(file: NodeFile, kind: str, own: str, name: str, topic: str) -> list[Edit]:
    """Give each class that sets the class attribute `kind` to another type than `own` a topic of its own."""
    return [
        insert_after(each, f"{name} = {f'{topic}_{ast.unparse(each.value).lower()}'!r}")
        for owner in file.nodes
        if isinstance(owner, ast.ClassDef)
        for each in owner.body
        if isinstance(each, ast.Assign) and ast.unparse(each.targets[0]) == kind and ast.unparse(each.value) != own
    ]


def _topic_text(file: NodeFile, code: ast.expr | None) -> str:
    """The topic's name, without its leading slash, given as a literal or a name that a literal is assigned to."""
    match code:
        case ast.Constant(value=str() as text):
            return text.lstrip("/")
        case ast.Name(id=name) | ast.Attribute(attr=name):
            for each in ast.walk(file.tree):
                match each:
                    case ast.Assign(
                        targets=[ast.Name(id=at) | ast.Attribute(attr=at)], value=ast.Constant(value=value)
                    ):
                        if at == name:
                            return str(value).lstrip("/")
    return ""


def _double_quoted(code: str) -> str:
    """The code with double quotation marks only, for use within an f-string in single ones."""
    return code.replace("'", '"')


def set_period(file: NodeFile, code: str) -> list[Edit]:
    """Set the timer's period in seconds; without a timer, the duration of the only sleep."""
    if file.first_timer is not None:
        period = argument(file.first_timer, 0, "timer_period_sec")
        return [replace_node(file.text, period, code)] if period is not None else []
    sleeps = [call for call in file.calls("sleep") if call.args]
    return [replace_node(file.text, sleeps[0].args[0], code)] if len(sleeps) == 1 else []


def keep_one_timer(file: NodeFile) -> list[Edit]:
    """Remove the timers that are created beside the first one with the same callback."""
    if file.first_timer is None:
        return []
    callback = argument(file.first_timer, 1, "callback")
    others = [
        file.statement(each)
        for each in file.timers
        if each is not file.first_timer
        and file.function_around(each) is file.function_around(file.first_timer)
        and callback is not None
        and (other := argument(each, 1, "callback")) is not None
        and ast.unparse(other) == ast.unparse(callback)
    ]
    return [remove_statement(file.text, each) for each in others]
