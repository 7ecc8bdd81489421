import concurrent.futures
import threading
import time
import rclpy
from rclpy.node import Node
from rclpy.task import Future
from rclpy.executors import MultiThreadedExecutor, ExternalShutdownException
from rclpy.callback_groups import ReentrantCallbackGroup
from example_interfaces.srv import AddTwoInts


class NebenlaeufigerDienst(Node):
    def __init__(self):
        super().__init__('nebenlaeufig')
        self.pool = concurrent.futures.ThreadPoolExecutor(max_workers=4)
        self.ende = threading.Event()
        self.zaehler = 0
        self.start = time.time()
        self.create_service(AddTwoInts, 'slow_add', self.langsam, callback_group=ReentrantCallbackGroup())
        self.create_timer(0.1, self.takt, callback_group=ReentrantCallbackGroup())

    async def langsam(self, anfrage, antwort):
        fertig = Future(executor=self.executor)
        self.pool.submit(self.arbeite, anfrage.a, anfrage.b, fertig)
        antwort.sum = await fertig
        return antwort

    def arbeite(self, a, b, fertig):
        self.ende.wait(3.0)
        fertig.set_result(a + b)

    def takt(self):
        self.zaehler += 1
        if self.zaehler % 10 == 0:
            self.get_logger().info(
                f'{time.time():.3f} Takt Nummer {self.zaehler} ({time.time() - self.start:.1f} s seit dem Start)')


def main():
    rclpy.init()
    knoten = NebenlaeufigerDienst()
    ausfuehrer = MultiThreadedExecutor(num_threads=4)
    ausfuehrer.add_node(knoten)
    try:
        ausfuehrer.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        knoten.ende.set()
        knoten.pool.shutdown()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
