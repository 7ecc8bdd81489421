"""Messages as text, compared with what `ros2 topic echo` prints."""

from __future__ import annotations

from typing import Any

from geometry_msgs.msg import PoseWithCovariance, Twist
from rcl_interfaces.msg import ParameterValue
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Byte, Float64, Float64MultiArray, String

from tutor.ros import bundled_interfaces
from tutor.ros.fields import fill, leaf_fields
from tutor.ros.interfaces import interface_class
from tutor.ros.yaml_format import DEFAULT_MAX_LENGTH, number_at, numeric_fields, to_yaml
from tutor.ros_model import Field


def test_nested_messages_are_blocks_in_field_order() -> None:
    twist = Twist()
    twist.angular.z = 0.5
    assert to_yaml(twist) == "linear:\n  x: 0.0\n  y: 0.0\n  z: 0.0\nangular:\n  x: 0.0\n  y: 0.0\n  z: 0.5\n"


def test_strings_are_quoted_where_necessary_and_truncated_if_long() -> None:
    assert to_yaml(String(data="Hello World: 3")) == "data: 'Hello World: 3'\n"
    assert to_yaml(String(data="wärme")) == "data: wärme\n"
    assert to_yaml(String(data="")) == "data: ''\n"
    assert to_yaml(String(data="x" * 200)) == f"data: {'x' * DEFAULT_MAX_LENGTH}...\n"


def test_arrays_are_lists_and_truncated_if_long() -> None:
    assert to_yaml(Float64MultiArray(data=[1.0, 2.0])).endswith("data:\n- 1.0\n- 2.0\n")
    lines = to_yaml(Float64MultiArray(data=[1.0] * 500)).splitlines()
    assert lines[-1] == "- '...'"
    assert lines.count("- 1.0") == DEFAULT_MAX_LENGTH
    assert to_yaml(PoseWithCovariance()).count("- 0.0") == 36


def test_a_byte_is_written_as_a_character() -> None:
    assert to_yaml(Byte(data=b"A")) == "data: A\n"


def test_numbers_are_found_by_path_in_nested_messages_and_arrays() -> None:
    scan = LaserScan(ranges=[1.0] * 500)
    fields = numeric_fields(scan)
    assert {"header.stamp.sec", "angle_min", "ranges[3]"} <= set(fields)
    assert "header.frame_id" not in fields
    assert len(fields) <= 64
    assert number_at(scan, "ranges[3]") == 1.0
    assert number_at(scan, "header.stamp.sec") == 0.0
    assert number_at(scan, "ranges[900]") is None
    assert number_at(scan, "no.such.field") is None
    assert number_at(Float64(data=float("nan")), "data") is None
    assert numeric_fields(String(data="3")) == ()


def test_every_numeric_field_can_be_read() -> None:
    for message in (Twist(), PoseWithCovariance(), Float64MultiArray(data=[1.0]), ParameterValue()):
        assert all(number_at(message, path) is not None for path in numeric_fields(message)), message


bundled_interfaces.activate()


def request_of(type_name: str) -> Any:
    return interface_class(type_name).Request()


def test_a_request_form_has_the_leaf_fields_with_their_defaults() -> None:
    two_ints = [Field("a", "int64", "0"), Field("b", "int64", "0")]
    assert list(leaf_fields(request_of("example_interfaces/srv/AddTwoInts"))) == two_ints
    found = list(leaf_fields(request_of("nav_msgs/srv/GetPlan")))
    assert Field("start.pose.position.x", "double", "0.0") in found
    assert Field("start.header.frame_id", "string", "") in found
    assert Field("start.pose.orientation.w", "double", "1.0") in found


def test_a_request_is_filled_from_form_values() -> None:
    values = {"start.pose.position.x": 2.0, "start.header.frame_id": "map"}
    request = fill(request_of("nav_msgs/srv/GetPlan"), values)
    assert request.start.pose.position.x == 2.0
    assert request.start.header.frame_id == "map"
