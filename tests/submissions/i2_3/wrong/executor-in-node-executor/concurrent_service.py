#!/usr/bin/env python3
import time
import threading

import rclpy
from rclpy.executors import MultiThreadedExecutor
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


class SlowAddController(Node):
    """예전에는 일반 클래스였는데 Node 를 상속하도록 바꿈 (2차 리팩토링)"""

    def __init__(self):
        super().__init__('slow_add_controller')
        self.executor = None
        self.running = False
        self.tick = 0
        self.lock = threading.Lock()

    def initialize(self):
        print("🚀 컨트롤러 초기화 중...")
        group = ReentrantCallbackGroup()
        self.srv = self.create_service(
            AddTwoInts, 'slow_add', self.slow_add_cb, callback_group=group)
        self.timer = self.create_timer(0.1, self.timer_cb, callback_group=group)

        self.executor = MultiThreadedExecutor(num_threads=5)
        self.executor.add_node(self)
        self.running = True
        print("✅ 초기화 완료")
        return True

    def run(self):
        try:
            self.executor.spin()
        except KeyboardInterrupt:
            print("\n🛑 종료 신호 수신됨")
        finally:
            self.running = False

    def slow_add_cb(self, request, response):
        self.get_logger().info(f"📨 요청: {request.a} + {request.b}")
        start = time.time()
        while self.running and time.time() - start < 3.0:
            time.sleep(0.1)
        response.sum = request.a + request.b
        return response

    def timer_cb(self):
        with self.lock:
            self.tick += 1
            tick = self.tick
        if tick % 10 == 0:
            self.get_logger().info(f"⏳ tick {tick}")


def main():
    rclpy.init()
    controller = SlowAddController()
    if controller.initialize():
        controller.run()
    controller.destroy_node()
    rclpy.try_shutdown()
    print("👋 프로그램 종료")


if __name__ == '__main__':
    main()
