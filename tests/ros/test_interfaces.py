"""The bundled example_interfaces matches the original: same type hashes and fields, and all kinds work over DDS."""

import ctypes
import hashlib
import importlib.util
import json
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.ros.ordinary_domain import ordinary_domain
from tutor.errors import InterfacesNotBuiltError
from tutor.ros import bundled_interfaces

PACKAGE = "example_interfaces"
SERVICE = f"{PACKAGE}/srv/AddTwoInts"
MESSAGE = f"{PACKAGE}/msg/String"

# As published in the design document of rmw_zenoh, in the key of an AddTwoInts service.
PUBLISHED_HASH = "RIHS01_e118de6bf5eeb66a2491b5bda11202e7b68f198d6f67922cf30364858239c81a"

# Type ids of type_description_interfaces/msg/FieldType.
NESTED, UINT8, INT32, UINT32, INT64, STRING = 1, 3, 6, 7, 8, 17
ARRAY, BOUNDED_SEQUENCE = 48, 96

Fields = dict[str, tuple[int, int, str]]

# The tested types and every type that their descriptions refer to: field name -> (type id, capacity, nested type).
TYPES: dict[str, Fields] = {
    MESSAGE: {"data": (STRING, 0, "")},
    SERVICE: {
        "request_message": (NESTED, 0, f"{SERVICE}_Request"),
        "response_message": (NESTED, 0, f"{SERVICE}_Response"),
        "event_message": (NESTED, 0, f"{SERVICE}_Event"),
    },
    f"{SERVICE}_Request": {"a": (INT64, 0, ""), "b": (INT64, 0, "")},
    f"{SERVICE}_Response": {"sum": (INT64, 0, "")},
    f"{SERVICE}_Event": {
        "info": (NESTED, 0, "service_msgs/msg/ServiceEventInfo"),
        "request": (NESTED + BOUNDED_SEQUENCE, 1, f"{SERVICE}_Request"),
        "response": (NESTED + BOUNDED_SEQUENCE, 1, f"{SERVICE}_Response"),
    },
    "service_msgs/msg/ServiceEventInfo": {
        "event_type": (UINT8, 0, ""),
        "stamp": (NESTED, 0, "builtin_interfaces/msg/Time"),
        "client_gid": (UINT8 + ARRAY, 16, ""),
        "sequence_number": (INT64, 0, ""),
    },
    "builtin_interfaces/msg/Time": {"sec": (INT32, 0, ""), "nanosec": (UINT32, 0, "")},
}

# A server and a client in a process of their own; `seen` is what it observed.
ADDS = """
import json
import rclpy
import example_interfaces
from example_interfaces.srv import AddTwoInts
from rclpy.qos import QoSProfile
from rclpy.service_introspection import ServiceIntrospectionState

def add(request, response):
    response.sum = request.a + request.b
    return response

def announced(topic):
    endpoints = [
        *node.get_publishers_info_by_topic(topic, no_mangle=True),
        *node.get_subscriptions_info_by_topic(topic, no_mangle=True),
    ]
    return sorted({str(endpoint.topic_type_hash) for endpoint in endpoints})

rclpy.init()
node = rclpy.create_node("interfaces_test")
service = node.create_service(AddTwoInts, "add", add)
service.configure_introspection(node.get_clock(), QoSProfile(depth=10), ServiceIntrospectionState.CONTENTS)
client = node.create_client(AddTwoInts, "add")
assert client.wait_for_service(10)
answer = client.call_async(AddTwoInts.Request(a=-2, b=2**40))
rclpy.spin_until_future_complete(node, answer, timeout_sec=10)
seen = {
    "file": example_interfaces.__file__,
    "sum": answer.result().sum,
    "request": announced("rq/addRequest"),
    "response": announced("rr/addReply"),
    "event": announced("rt/add/_service_event"),
}
"""


# Prints each type's fields, beside those of the type of the same name in std_msgs and std_srvs.
FIELDS = f"""
from tutor.ros.bundled_interfaces import activate
activate()
import json
import {PACKAGE}.msg, {PACKAGE}.srv, std_msgs.msg, std_srvs.srv

def fields(kind):
    return [
        [name, declared.replace("std_msgs/", "").replace("{PACKAGE}/", "")]
        for name, declared in kind.get_fields_and_field_types().items()
    ]

def types(module):
    return {{name: kind for name, kind in vars(module).items() if isinstance(kind, type)}}

seen = {{}}
for name, kind in types({PACKAGE}.msg).items():
    if name != "WString":
        seen[name] = [fields(kind), fields(getattr(std_msgs.msg, name))]
for name in ("SetBool", "Trigger"):
    ours, theirs = getattr({PACKAGE}.srv, name), getattr(std_srvs.srv, name)
    seen[name + ".Request"] = [fields(ours.Request), fields(theirs.Request)]
    seen[name + ".Response"] = [fields(ours.Response), fields(theirs.Response)]
print(json.dumps(seen))
"""

# After ADDS: publishes two strings to itself and calls its own action.
EXCHANGES = f"""
from {PACKAGE}.action import Fibonacci
from {PACKAGE}.msg import String, WString
from rclpy.action import ActionClient, ActionServer

text = []
def listen(message):
    text.append(message.data)

def count(goal):
    goal.succeed()
    return Fibonacci.Result(sequence=[0, 1, 1][: goal.request.order])

listener = node.create_subscription(String, "text", listen, 10)
wide_listener = node.create_subscription(WString, "wide", listen, 10)
publisher, wide = node.create_publisher(String, "text", 10), node.create_publisher(WString, "wide", 10)
server = ActionServer(node, Fibonacci, "fibonacci", count)
client = ActionClient(node, Fibonacci, "fibonacci")
assert client.wait_for_server(10)
while not (publisher.get_subscription_count() and wide.get_subscription_count()):
    rclpy.spin_once(node, timeout_sec=0.1)
publisher.publish(String(data="good day"))
while len(text) < 1:
    rclpy.spin_once(node, timeout_sec=10)
wide.publish(WString(data="Grüß Gott"))
while len(text) < 2:
    rclpy.spin_once(node, timeout_sec=10)
goal = client.send_goal_async(Fibonacci.Goal(order=3))
rclpy.spin_until_future_complete(node, goal, timeout_sec=10)
result = goal.result().get_result_async()
rclpy.spin_until_future_complete(node, result, timeout_sec=10)
seen |= {{"text": text, "sequence": result.result().result.sequence.tolist()}}
"""
PRINTS = """
print(json.dumps(seen))
node.destroy_node()
rclpy.try_shutdown()
"""


@pytest.fixture
def environment(tmp_path: Path) -> Iterator[dict[str, str]]:
    """An environment without ROS, except for a private domain limited to this host."""
    kept = {name: os.environ[name] for name in ("PATH", "HOME", "TMPDIR") if name in os.environ}
    with ordinary_domain() as domain:
        yield {
            **kept,
            "ROS_DOMAIN_ID": str(domain),
            "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
            "ROS_LOG_DIR": str(tmp_path / "log"),
        }


def run_python(source: str, environment: dict[str, str]) -> Any:
    """Run the source in a Python process and return its output, parsed as JSON."""
    done = subprocess.run(
        [sys.executable, "-c", source], env=environment, capture_output=True, text=True, timeout=60, check=False
    )
    assert done.returncode == 0, done.stderr
    assert not done.stderr
    return json.loads(done.stdout)


def type_hash(name: str) -> str:
    """Compute a type's RIHS01 hash (REP-2011): SHA-256 over its description and all referenced ones, as JSON."""

    def described(name: str) -> dict[str, Any]:
        fields = [
            {
                "name": field,
                "type": {"type_id": kind, "capacity": capacity, "string_capacity": 0, "nested_type_name": nested},
            }
            for field, (kind, capacity, nested) in TYPES[name].items()
        ]
        return {"type_name": name, "fields": fields}

    def referenced(name: str) -> set[str]:
        nested = {nested for _, _, nested in TYPES[name].values() if nested}
        return nested.union(*map(referenced, nested))

    description = {
        "type_description": described(name),
        "referenced_type_descriptions": [described(other) for other in sorted(referenced(name))],
    }
    return "RIHS01_" + hashlib.sha256(json.dumps(description).encode()).hexdigest()


def library_hash(name: str) -> str:
    """Return the type hash that the built library contains and passes to the middleware."""

    class TypeHash(ctypes.Structure):
        _fields_ = (("version", ctypes.c_uint8), ("value", ctypes.c_uint8 * 32))

    library = ctypes.CDLL(str(bundled_interfaces.library_dir() / f"lib{PACKAGE}__rosidl_generator_c.so"))
    get_type_hash = library[f"{name.replace('/', '__')}__get_type_hash"]
    get_type_hash.restype = ctypes.POINTER(TypeHash)
    found = get_type_hash(None).contents
    return f"RIHS{found.version:02}_{bytes(found.value).hex()}"


def test_the_definition_hashes_to_the_published_constant() -> None:
    assert type_hash(SERVICE) == PUBLISHED_HASH


@pytest.mark.parametrize("name", [SERVICE, f"{SERVICE}_Request", f"{SERVICE}_Response", f"{SERVICE}_Event", MESSAGE])
def test_the_built_library_contains_the_hash(name: str) -> None:
    assert library_hash(name) == type_hash(name)


def test_a_process_can_import_it_through_its_environment(environment: dict[str, str]) -> None:
    environment |= {
        "PYTHONPATH": str(bundled_interfaces.site_packages()),
        "AMENT_PREFIX_PATH": str(bundled_interfaces.prefix()),
        "LD_LIBRARY_PATH": str(bundled_interfaces.library_dir()),
    }
    seen = run_python(ADDS + PRINTS, environment)
    assert Path(seen["file"]).is_relative_to(bundled_interfaces.prefix())
    assert seen["sum"] == 2**40 - 2
    for kind in ("request", "response", "event"):
        assert seen[kind] == [type_hash(f"{SERVICE}_{kind.title()}")]


def test_activate_makes_services_messages_and_actions_work_in_the_running_process(environment: dict[str, str]) -> None:
    activate = "from tutor.ros.bundled_interfaces import activate; activate()"
    seen = run_python(activate + ADDS + EXCHANGES + PRINTS, environment)
    assert Path(seen["file"]).is_relative_to(bundled_interfaces.prefix())
    assert seen["sum"] == 2**40 - 2
    assert seen["text"] == ["good day", "Grüß Gott"]
    assert seen["sequence"] == [0, 1, 1]


def test_its_types_have_the_fields_of_those_that_they_are_copies_of(environment: dict[str, str]) -> None:
    seen = run_python(FIELDS, environment)
    assert len(seen) == 28 + 2 * 2  # the messages but WString; SetBool and Trigger, request and response
    assert {name: fields for name, (fields, _) in seen.items()} == {name: fields for name, (_, fields) in seen.items()}


def test_activate_does_nothing_if_the_package_is_installed(environment: dict[str, str], tmp_path: Path) -> None:
    (tmp_path / PACKAGE).mkdir()
    (tmp_path / PACKAGE / "__init__.py").touch()
    source = """
import json, os, sys
from tutor.ros.bundled_interfaces import activate
before = [list(sys.path), dict(os.environ)]
activate()
import example_interfaces
print(json.dumps({"file": example_interfaces.__file__, "untouched": before == [sys.path, dict(os.environ)]}))
"""
    seen = run_python(source, environment | {"PYTHONPATH": str(tmp_path)})
    assert seen == {"file": str(tmp_path / PACKAGE / "__init__.py"), "untouched": True}


def test_a_missing_prefix_is_reported_with_a_hint(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(bundled_interfaces, "prefix", lambda: tmp_path)
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    with pytest.raises(InterfacesNotBuiltError, match="uv sync --reinstall-package ros-tutor"):
        bundled_interfaces.activate()


@pytest.mark.parametrize("kind", ["srv", "idl", "json"])
def test_the_definition_is_installed(kind: str) -> None:
    assert (bundled_interfaces.prefix() / "share" / PACKAGE / "srv" / f"AddTwoInts.{kind}").is_file()


def test_the_package_is_in_the_ament_index() -> None:
    index = bundled_interfaces.prefix() / "share" / "ament_index" / "resource_index"
    assert (index / "packages" / PACKAGE).is_file()
    assert "srv/AddTwoInts.srv" in (index / "rosidl_interfaces" / PACKAGE).read_text().split()
