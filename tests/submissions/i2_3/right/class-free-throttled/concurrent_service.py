import rclpy
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.duration import Duration
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor
from example_interfaces.srv import AddTwoInts

ticks = 0


def main():
    rclpy.init()
    node = rclpy.create_node('concurrent_service')
    log = node.get_logger()

    def on_timer():
        global ticks
        ticks += 1
        log.info(f'fast timer has ticked {ticks} times', throttle_duration_sec=1.0)

    def on_request(request, response):
        log.info('request')
        node.get_clock().sleep_for(Duration(seconds=3))
        response.sum = request.a + request.b
        log.info('done')
        return response

    node.create_service(AddTwoInts, 'slow_add', on_request, callback_group=ReentrantCallbackGroup())
    node.create_timer(0.1, on_timer, callback_group=ReentrantCallbackGroup())
    executor = MultiThreadedExecutor(num_threads=6)
    executor.add_node(node)
    try:
        executor.spin()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    rclpy.try_shutdown()


if __name__ == '__main__':
    main()
