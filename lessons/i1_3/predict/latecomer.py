"""A robot says where it is. Only then, a dashboard comes."""

import rclpy
from rclpy.executors import SingleThreadedExecutor
from std_msgs.msg import String
from std_srvs.srv import Trigger


def tell(request, response):
    response.message = "dock"
    return response


def hear(message):
    heard.append(message.data)


def spin_until(condition):
    for _ in range(200):
        if condition():
            return
        executor.spin_once(timeout_sec=0.1)
    raise SystemExit("this takes too long: is the machine very busy?")


rclpy.init()
robot = rclpy.create_node("robot")
place = robot.create_publisher(String, "place", 10)
robot.create_service(Trigger, "where_are_you", tell)
place.publish(String(data="dock"))

heard = []
dashboard = rclpy.create_node("dashboard")
dashboard.create_subscription(String, "place", hear, 10)
client = dashboard.create_client(Trigger, "where_are_you")

executor = SingleThreadedExecutor()
executor.add_node(robot)
executor.add_node(dashboard)
spin_until(lambda: place.get_subscription_count() == 1)
spin_until(client.service_is_ready)
answer = client.call_async(Trigger.Request())
spin_until(answer.done)
place.publish(String(data="kitchen"))
spin_until(lambda: "kitchen" in heard)
told = answer.result().message
print(f"heard: {', '.join(heard)}; was told: {told}", flush=True)
rclpy.try_shutdown()
