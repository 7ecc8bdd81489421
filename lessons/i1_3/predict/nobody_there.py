"""A publisher without a subscriber, and a client without a server."""

import threading

import rclpy
from std_msgs.msg import String
from std_srvs.srv import Trigger


def ends(task):
    """Run a task; return whether it ends within two seconds."""
    thread = threading.Thread(target=task, daemon=True)
    thread.start()
    thread.join(timeout=2.0)
    return not thread.is_alive()


rclpy.init()
node = rclpy.create_node("alone")
publisher = node.create_publisher(String, "news", 10)
client = node.create_client(Trigger, "status")

published = ends(lambda: publisher.publish(String(data="hello")))
print(f"publish() returned: {published}", flush=True)
called = ends(lambda: client.call(Trigger.Request()))
print(f"call() returned: {called}", flush=True)
print(f"publish(): {published}, call(): {called}", flush=True)
