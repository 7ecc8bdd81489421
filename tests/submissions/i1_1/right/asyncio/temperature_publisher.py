import random
import rclpy
from rclpy.node import Node
from rclpy.executors import ExternalShutdownException
from std_msgs.msg import Float64
import asyncio


async def main():
    rclpy.init()
    n = Node("a")
    hz = n.declare_parameter("publish_rate", 2.0).value
    nm = n.declare_parameter("sensor_name", "z").value
    p = n.create_publisher(Float64, "/sensor/temperature", 10)

    async def pub():
        while True:
            p.publish(Float64(data=random.uniform(20, 30)))
            n.get_logger().info(f"{nm} ok")
            await asyncio.sleep(1 / hz)

    async def spin():
        while rclpy.ok():
            rclpy.spin_once(n, timeout_sec=0)
            await asyncio.sleep(0.01)

    t = asyncio.create_task(pub())
    await spin()
    t.cancel()


if __name__ == "__main__":
    try:
        asyncio.run(main())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
