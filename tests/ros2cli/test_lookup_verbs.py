"""ros2 interface and ros2 pkg, which need no nodes."""

from __future__ import annotations

import argparse

import pytest

from tests.ros2cli.bench import Bench, Ran


def test_a_definition_is_shown_with_nested_types_below_their_fields(bench: Bench) -> None:
    assert bench.ros2("interface", "show", "example_interfaces/srv/AddTwoInts") == Ran(
        "int64 a\nint64 b\n---\nint64 sum\n", "", 0
    )
    assert bench.ros2("interface", "show", "geometry_msgs/msg/TwistStamped").stdout == (
        "# A twist with reference coordinate frame and timestamp\n\n"
        "std_msgs/Header header\n\tbuiltin_interfaces/Time stamp\n\t\tint32 sec\n\t\tuint32 nanosec\n"
        "\tstring frame_id\n"
        "Twist twist\n\tVector3  linear\n\t\tfloat64 x\n\t\tfloat64 y\n\t\tfloat64 z\n"
        "\tVector3  angular\n\t\tfloat64 x\n\t\tfloat64 y\n\t\tfloat64 z\n"
    )
    bare = bench.ros2("interface", "show", "--no-comments", "geometry_msgs/msg/TwistStamped").stdout
    assert bare.startswith("std_msgs/Header header\n")
    assert "#" not in bare
    assert bench.ros2("interface", "show", "-", stdin="std_msgs/msg/Bool\n").stdout.endswith("bool data\n")


def test_comments_are_left_out_as_by_rosidls_parser(bench: Bench) -> None:
    # It works line by line: it leaves the # of a comment after a field, and keeps comment lines that are indented.
    bare = bench.ros2("interface", "show", "--no-comments", "stereo_msgs/msg/DisparityImage").stdout.splitlines()
    assert "float32 f #" in bare
    assert "\tstd_msgs/Header header #" in bare
    assert "\t                             # Header frame_id should be optical frame of camera" in bare
    assert "# Floating point disparity image." not in " ".join(bare)
    log = bench.ros2("interface", "show", "--no-comments", "rcl_interfaces/msg/Log").stdout.splitlines()
    assert log[:4] == ["##", "##", "##", "uint8 DEBUG=10"]
    assert bench.ros2("interface", "show", "std_msgs//String").stderr == (
        "Invalid name 'std_msgs//String'. Must not contain empty parts\n"
    )


def test_missing_interfaces_and_packages_are_reported(bench: Bench) -> None:
    show = ("interface", "show")
    assert bench.ros2(*show, "std_msgs/String").stderr == (
        "Invalid name 'std_msgs/String'. Expected three parts separated by '/'\n"
    )
    assert bench.ros2(*show, "nopkg/msg/X") == Ran("", "Unknown package 'nopkg'\n", 1)
    assert bench.ros2(*show, "std_msgs/msg/Strin").stderr.startswith("Could not find the interface '")
    assert bench.ros2("interface", "package", "nopkg") == Ran("", "Unknown package 'nopkg'\n", 1)
    assert bench.ros2("pkg", "prefix", "nopkg") == Ran("", "Package not found\n", 1)
    assert bench.ros2("pkg", "xml", "nopkg") == Ran("", "Package not found\n", 1)
    assert bench.ros2("pkg", "executables", "nopkg") == Ran("", "Package 'nopkg' not found\n", 1)


def test_types_and_packages_are_listed(bench: Bench) -> None:
    listed = bench.ros2("interface", "list").stdout.splitlines()
    assert listed.index("Messages:") < listed.index("Services:") < listed.index("Actions:")
    assert "    std_msgs/msg/Float64" in listed
    assert bench.ros2("interface", "list", "-s").stdout.startswith("Services:\n    action_msgs/srv/CancelGoal\n")
    assert bench.ros2("interface", "package", "std_srvs").stdout == (
        "std_srvs/srv/Empty\nstd_srvs/srv/SetBool\nstd_srvs/srv/Trigger\n"
    )
    assert "std_msgs" in bench.ros2("interface", "packages", "-m").stdout.split()
    assert "std_srvs" not in bench.ros2("interface", "packages", "-m").stdout.split()
    assert bench.ros2("interface", "proto", "std_msgs/msg/String").stdout == "\"data: ''\n\"\n"
    packages = bench.ros2("pkg", "list").stdout.split()
    assert packages == sorted(packages)
    assert {"rclpy", "std_msgs", "demo_nodes_py"} <= set(packages)
    assert "demo_nodes_py talker" in bench.ros2("pkg", "executables", "demo_nodes_py").stdout.splitlines()


def test_an_unsupported_doctor_option_is_refused_in_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    from tutor.bundled_ros.ros2.doctor import GRAMMAR
    from tutor.bundled_ros.ros2.parsing import fill

    parser = argparse.ArgumentParser()
    fill(parser, GRAMMAR["doctor"])
    arguments = parser.parse_args(["--report-failed"])
    assert arguments.run(arguments) == 2
    captured = capsys.readouterr()
    assert (captured.out, captured.err.count("\n")) == ("", 1)
    assert "--report-failed is not supported" in captured.err
