"""Small programs that try out ROS in a separate process, for the doctor.

Run by path, with any Python: none of our code is imported. The last line on stdout is the result, as JSON.

    probe.py import             how long `import rclpy` takes, and where it is imported from
    probe.py interfaces         whether example_interfaces/srv/AddTwoInts can be used
    probe.py listen TOPIC       prints "ready", then waits for one message
    probe.py talk TOPIC         publishes until it is killed
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable


def _import() -> dict[str, object]:
    start = time.monotonic()
    import rclpy

    return {"seconds": time.monotonic() - start, "file": rclpy.__file__}


def _interfaces() -> dict[str, object]:
    import example_interfaces
    from example_interfaces.srv import AddTwoInts
    from rclpy.type_support import check_for_type_support

    check_for_type_support(AddTwoInts)  # loads the libraries
    return {"file": example_interfaces.__file__}


def _listen(topic: str) -> dict[str, object]:
    import rclpy
    from std_msgs.msg import String

    received: list[object] = []
    rclpy.init()
    node = rclpy.create_node("doctor_listener")
    node.create_subscription(String, topic, received.append, 10)
    print("ready", flush=True)
    while not received:
        rclpy.spin_once(node, timeout_sec=1.0)
    return {"messages": len(received)}


def _talk(topic: str) -> dict[str, object]:
    import rclpy
    from std_msgs.msg import String

    rclpy.init()
    node = rclpy.create_node("doctor_talker")
    publisher = node.create_publisher(String, topic, 10)
    node.create_timer(0.01, lambda: publisher.publish(String(data="hello")))
    rclpy.spin(node)
    return {}


if __name__ == "__main__":
    _COMMANDS: dict[str, Callable[..., dict[str, object]]] = {
        "import": _import,
        "interfaces": _interfaces,
        "listen": _listen,
        "talk": _talk,
    }
    print(json.dumps(_COMMANDS[sys.argv[1]](*sys.argv[2:])), flush=True)
