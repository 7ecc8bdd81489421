from __future__ import annotations

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tutor.ros_model import Parameter
from tutor.ros_model.values import format_value, parse_parameter, parse_value


@pytest.mark.parametrize(
    ("type_name", "text", "value"),
    [
        ("int64", " -3 ", -3),
        ("uint8", "0xff", 255),
        ("boolean", "True", True),
        ("double", "2", 2.0),
        ("float", ".inf", float("inf")),
        ("string", " a ", " a "),
        ("string<5>", "abcde", "abcde"),
        ("octet", "7", 7),
        ("sequence<double>", "[1, 2.5]", [1.0, 2.5]),
        ("sequence<string, 3>", '[a, "b c"]', ["a", "b c"]),
        ("int32[2]", "[1, 2]", [1, 2]),
        ("sequence<int64>", "", []),
    ],
)
def test_text_is_parsed_into_a_value(type_name: str, text: str, value: Any) -> None:
    parsed = parse_value(type_name, text)
    assert parsed == value
    assert type(parsed) is type(value)


@pytest.mark.parametrize(
    ("type_name", "text", "message"),
    [
        ("int64", "3.5", "whole number"),
        ("int64", "", "whole number"),
        ("uint8", "256", "from 0 to 255"),
        ("int8", "-129", "from -128 to 127"),
        ("boolean", "yes", "true or false"),
        ("double", "warm", "such as 2.5"),
        ("string<2>", "abc", "At most 2 characters"),
        ("sequence<double>", "1, 2", "brackets"),
        ("sequence<double>", "[1, x]", "such as 2.5"),
        ("sequence<int64, 1>", "[1, 2]", "At most 1"),
        ("int32[2]", "[1]", "Exactly 2"),
        ("sequence<rcl_interfaces/Parameter>", "[1]", "cannot be filled in"),
    ],
)
def test_parse_errors_say_what_is_wrong(type_name: str, text: str, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        parse_value(type_name, text)


@given(st.lists(st.text(st.characters(codec="utf-8", exclude_categories=["Cc", "Cs", "Zl", "Zp"]))))
def test_a_formatted_list_of_strings_parses_back(values: list[str]) -> None:
    assert parse_value("sequence<string>", format_value(values)) == values


@given(st.one_of(st.integers(-(2**63), 2**63 - 1), st.booleans(), st.floats(allow_nan=False)))
def test_a_formatted_value_parses_back(value: int | float | bool) -> None:
    kind = {bool: "boolean", int: "int64", float: "double"}[type(value)]
    assert parse_value(kind, format_value(value)) == value


def test_a_parameter_keeps_its_type_and_an_unset_one_takes_it_from_the_text() -> None:
    assert parse_parameter(Parameter("/n", "rate", "double", 1.0), "5") == ("double", 5.0)
    assert parse_parameter(Parameter("/n", "names", "string array", []), "[1]") == ("string array", ["1"])
    unset = Parameter("/n", "any", "not set", None)
    assert parse_parameter(unset, "5") == ("integer", 5)
    assert parse_parameter(unset, "true") == ("boolean", True)
    assert parse_parameter(unset, "[") == ("string", "[")
