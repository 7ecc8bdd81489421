import rclpy
from rclpy.node import Node
from std_msgs.msg import Float64
import asyncio


async def work(n):
    async with asyncio.TaskGroup() as g:
        g.create_task(pub(n))


async def pub(n):
    p = n.create_publisher(Float64, "/sensor/temperature", 10)
    p.publish(25)


if __name__ == "__main__":
    rclpy.init()
    n = Node("t")
    asyncio.run(work(n))
