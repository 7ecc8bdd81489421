"""Messages as plain data."""

from __future__ import annotations

import json

from geometry_msgs.msg import PoseWithCovariance
from rcl_interfaces.msg import ParameterValue

from tutor.ros.messages import to_plain


def test_every_kind_of_array_becomes_a_list() -> None:
    covariance = to_plain(PoseWithCovariance(covariance=[0.5] * 36))["covariance"]  # of a fixed size: numpy's
    assert (covariance, {type(number) for number in covariance}) == ([0.5] * 36, {float})
    value = to_plain(ParameterValue(double_array_value=[1.5], byte_array_value=[b"A"]))
    assert (value["double_array_value"], value["byte_array_value"]) == ([1.5], [[65]])
    json.dumps(value)
