"""Message types are found by name."""

from __future__ import annotations

import subprocess
import sys

CODE = """
import sys
from tutor.ros.interfaces import interface_class
from tutor.errors import UnknownType
for name in ("this.msg/msg/X", "this/msg/X", "antigravity/msg/X", "os/path/join", "../msg/X", "std_msgs/msg/X"):
    try:
        interface_class(name)
    except UnknownType:
        print(name)
print("this" in sys.modules, "antigravity" in sys.modules, interface_class("std_msgs/msg/Float64").__name__)
"""


def test_a_package_without_interfaces_is_unknown_and_not_imported() -> None:
    ran = subprocess.run([sys.executable, "-c", CODE], capture_output=True, text=True, check=True)
    assert ran.stdout.splitlines() == [
        "this.msg/msg/X",
        "this/msg/X",
        "antigravity/msg/X",
        "os/path/join",
        "../msg/X",
        "std_msgs/msg/X",
        "False False Float64",
    ]
