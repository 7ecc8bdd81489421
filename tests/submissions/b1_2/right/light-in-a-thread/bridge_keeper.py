import threading

import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import Bool
from std_srvs.srv import SetBool

rclpy.init()
node = Node("bridge_keeper")
light = node.create_publisher(Bool, "/bridge/light", 10)
stop = threading.Event()


def blink():
    on = True
    while not stop.wait(0.1):
        light.publish(Bool(data=on))
        on = not on


async def move(request, response):
    if not client.service_is_ready():
        response.success, response.message = False, "Harbour unreachable"
        return response
    future = client.call_async(request)
    timer = node.create_timer(3.2, future.cancel)
    reply = await future
    node.destroy_timer(timer)
    if reply is None:
        response.success, response.message = False, "Harbour silent"
        return response
    response.success, response.message = reply.success, reply.message
    return response


client = node.create_client(SetBool, "/harbour/clearance")
node.create_service(SetBool, "/bridge/move", move, callback_group=ReentrantCallbackGroup())
thread = threading.Thread(target=blink)
thread.start()
try:
    rclpy.spin(node)
except (KeyboardInterrupt, ExternalShutdownException):
    pass
finally:
    stop.set()
    thread.join()
    rclpy.try_shutdown()
