"""Anna and Ben both listen to the radio, and both ask the adder."""

import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from std_msgs.msg import String


class Person(Node):
    """Keeps what it gets: messages and answers."""

    def __init__(self, name):
        super().__init__(name)
        self.got = []
        self.create_subscription(String, "news", self.hear, 10)
        self.adder = self.create_client(AddTwoInts, "add")

    def hear(self, message):
        self.got.append(message.data)

    def ask(self, a, b):
        future = self.adder.call_async(AddTwoInts.Request(a=a, b=b))
        future.add_done_callback(self.keep_answer)

    def keep_answer(self, future):
        self.got.append(str(future.result().sum))


def add(request, response):
    response.sum = request.a + request.b
    return response


def spin_until(condition):
    for _ in range(200):
        if condition():
            return
        executor.spin_once(timeout_sec=0.1)
    raise SystemExit("this takes too long: is the machine very busy?")


rclpy.init()
station = rclpy.create_node("station")
anna, ben = Person("anna"), Person("ben")
radio = station.create_publisher(String, "news", 10)
station.create_service(AddTwoInts, "add", add)
executor = SingleThreadedExecutor()
for node in (station, anna, ben):
    executor.add_node(node)
spin_until(lambda: radio.get_subscription_count() == 2)
spin_until(anna.adder.service_is_ready)
spin_until(ben.adder.service_is_ready)

radio.publish(String(data="hello"))
anna.ask(1, 1)
ben.ask(10, 10)
spin_until(lambda: len(anna.got + ben.got) >= 4)
for _ in range(5):  # is there more to come?
    executor.spin_once(timeout_sec=0.1)
annas, bens = ", ".join(sorted(anna.got)), ", ".join(sorted(ben.got))
print(f"Anna got {annas}; Ben got {bens}", flush=True)
rclpy.try_shutdown()
