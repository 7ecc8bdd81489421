import rclpy
from example_interfaces.srv import AddTwoInts
from rclpy.node import Node


class Chain(Node):
    def __init__(self):
        super().__init__('chain')
        self.todo = ['add', 'subtract', 'multiply', 'divide']
        self.finished = False
        self.next_call()

    def next_call(self):
        if not self.todo:
            self.finished = True
            return
        self.current = self.todo.pop(0)
        self.cli = self.create_client(AddTwoInts, self.current)
        self.cli.wait_for_service()
        self.cli.call_async(AddTwoInts.Request(a=8, b=2)).add_done_callback(self.answered)

    def answered(self, future):
        print(self.current, future.result().sum)
        self.next_call()


rclpy.init()
chain = Chain()
while not chain.finished:
    rclpy.spin_once(chain)
chain.destroy_node()
rclpy.shutdown()
