import threading
import time

import rclpy
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


heartbeat_period = 0.5

class CalculatorClient(Node):

    def __init__(self):
        super().__init__('calculator_client')
        self.log = self.get_logger()
        self.busy_with = 'nothing'
        self.running = True
        # a timer of the node would not fire while we wait for a service, so this is a thread
        self.heartbeat_thread = threading.Thread(target=self.heartbeat)
        self.heartbeat_thread.start()

    def heartbeat(self):
        started = time.time()
        while self.running:
            time.sleep(heartbeat_period)
            print('heartbeat, %.1f s, busy with %s' % (time.time() - started, self.busy_with))

    def ask(self, service, a, b):
        self.busy_with = service
        client = self.create_client(AddTwoInts, service)
        client.wait_for_service()
        request = AddTwoInts.Request()
        request.a = a
        request.b = b
        future = client.call_async(request)
        rclpy.spin_until_future_complete(self, future)
        self.log.info('%s(%d, %d) = %d' % (service, a, b, future.result().sum))
        self.busy_with = 'nothing'

    def stop(self):
        self.runing = False


def main():
    rclpy.init()
    calculator_client = CalculatorClient()
    calculator_client.ask('add', 100, 10)
    calculator_client.ask('subtract', 100, 10)
    calculator_client.ask('multiply', 100, 10)
    calculator_client.ask('divide', 100, 10)
    calculator_client.stop()
    calculator_client.destroy_node()
    rclpy.shutdown()


if __name__ == '__main__':
    main()
