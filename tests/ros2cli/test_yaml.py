"""The fast YAML writer for messages prints the same as PyYAML."""

from __future__ import annotations

import array
from typing import Any

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from tutor.ros.fast_yaml import dump_plain
from tutor.ros.yaml_format import _Dumper, to_csv


class FakeMessage:
    """Stands in for an rclpy message."""

    def __init__(self, **fields: Any) -> None:
        self.__dict__.update(fields)
        self._names = dict.fromkeys(fields, "")

    def get_fields_and_field_types(self) -> dict[str, str]:
        return self._names

    def to_dict(self) -> dict[str, Any]:
        return {name: self._to_plain(getattr(self, name)) for name in self._names}

    def _to_plain(self, value: Any) -> Any:
        if isinstance(value, FakeMessage):
            return value.to_dict()
        return list(value) if isinstance(value, array.array) else value


def dump_with_pyyaml(message: FakeMessage) -> str:
    return yaml.dump(message.to_dict(), Dumper=_Dumper, allow_unicode=True, width=2**60, sort_keys=False)


scalars = st.one_of(
    st.floats(),
    st.integers(-(2**63), 2**64),
    st.booleans(),
    st.text(max_size=12),
    st.text(alphabet="aB1 :#-'\"/._,[]{}?!&*|>%@`~=<\n\t\x85\u2028é0x+e", max_size=8),
    st.sampled_from(
        ["yes", "No", "null", "~", "1e5", "0x1F", "1_000", "12:30:00", "2001-01-01", "=", "<<", "Hello: 1"]
    ),
)


@given(scalars, st.lists(scalars, max_size=4), st.lists(st.floats(width=32), max_size=4))
def test_output_equals_that_of_pyyaml(one: Any, several: list[Any], numbers: list[float]) -> None:
    message = FakeMessage(data=one, several=several, nested=FakeMessage(x=one, numbers=array.array("d", numbers)))
    if (written := dump_plain(message, None)) is not None:
        assert written == dump_with_pyyaml(message)


@pytest.mark.parametrize("text", ["Hello World: 3", "it's so: yes", "map", "base_link", "a b", "robot1/chatter"])
def test_common_messages_need_no_pyyaml(text: str) -> None:
    message = FakeMessage(data=text, nested=FakeMessage(x=0.5, y=-3, on_time=True))
    written = dump_plain(message, 128)
    assert written is not None
    assert written == dump_with_pyyaml(message)


def test_empty_csv_cells_are_separated_as_by_rosidl_runtime_py() -> None:
    from rcl_interfaces.msg import LoggerLevel
    from std_msgs.msg import Int8MultiArray

    assert to_csv(LoggerLevel(name="", level=10)) == "10"
    assert to_csv(LoggerLevel(name="a", level=10)) == "a,10"
    assert to_csv(Int8MultiArray(data=[])) == "0,"
