import rclpy
from rclpy.executors import ExternalShutdownException
from rcl_interfaces.msg import SetParametersResult
from std_msgs.msg import String

rclpy.init()
n = rclpy.create_node("f")
P = {
    k: n.declare_parameter(k, v).value
    for k, v in dict(message_prefix="Hello", publish_rate=1.0, enabled=True).items()
}
if P["publish_rate"] <= 0:
    n.get_logger().warn("bad publish_rate")
    P["publish_rate"] = 1.0
pub = n.create_publisher(String, "/chatter", 10)
box = [None]


def tick():
    if P["enabled"]:
        pub.publish(String(data=P["message_prefix"]))


def start():
    box[0] = n.create_timer(1 / P["publish_rate"], tick)


def cb(ps):
    new = {**P, **{p.name: p.value for p in ps}}
    if new["publish_rate"] <= 0:
        return SetParametersResult(successful=False, reason="no")
    old = P["publish_rate"]
    P.update(new)
    if old != P["publish_rate"]:
        box[0].cancel()
        start()
    return SetParametersResult(successful=True)


n.add_on_set_parameters_callback(cb)
start()
try:
    rclpy.spin(n)
except (KeyboardInterrupt, ExternalShutdownException):
    pass
