import math
import sys
import time

import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from std_msgs.msg import String
from std_srvs.srv import Trigger


class PatrolScheduler(Node):
    def __init__(self):
        super().__init__('patrol_scheduler')

        # 1. 파라미터
        self.declare_parameter('patrol_mode', 'periodic')
        self.declare_parameter('message_prefix', 'Hello')
        self.declare_parameter('publish_rate', 1.0)  # Hz
        self.declare_parameter('enabled', True)

        self.timer = None
        self.seq = 0
        self.update_config()

        self.publisher_ = self.create_publisher(String, '/chatter', 10)

        # 로봇 상태 구독 (바쁘면 로그만 남김)
        self.status_sub = self.create_subscription(
            String, '/patrol_status', self._status_callback, 10)
        self.is_robot_busy = False

        # 2. 수동 트리거 서비스
        self.srv = self.create_service(Trigger, 'trigger_manual_patrol', self.manual_trigger_callback)

        self.restart_timer()
        self.add_on_set_parameters_callback(self.parameter_callback)
        self.get_logger().info('Patrol Scheduler ready.')

    def _status_callback(self, msg):
        self.is_robot_busy = msg.data.upper() in ['PATROLLING', 'MOVING']

    def check_rate(self, value):
        """문제가 있으면 이유(문자열), 없으면 빈 문자열."""
        if isinstance(value, bool) or not isinstance(value, float):
            return f'publish_rate must be a float, got {value!r}'
        if not math.isfinite(value) or value <= 0.0:
            return f'publish_rate must be greater than 0 Hz, got {value}'
        return ''

    def update_config(self, params=None):
        if params:
            for param in params:
                if param.name == 'patrol_mode':
                    self.mode = param.value
                elif param.name == 'message_prefix':
                    self.prefix = param.value
                elif param.name == 'publish_rate':
                    self.rate = param.value
                    self.restart_timer()
                elif param.name == 'enabled':
                    self.enabled = param.value
        else:
            self.mode = self.get_parameter('patrol_mode').get_parameter_value().string_value
            self.prefix = self.get_parameter('message_prefix').get_parameter_value().string_value
            self.rate = self.get_parameter('publish_rate').get_parameter_value().double_value
            self.enabled = self.get_parameter('enabled').get_parameter_value().bool_value

            problem = self.check_rate(self.rate)
            if problem:
                self.get_logger().error(f'Cannot start: {problem}')
                sys.exit(1)

    def restart_timer(self):
        if self.timer is not None:
            self.timer.cancel()
            self.destroy_timer(self.timer)
        self.timer = self.create_timer(1.0 / self.rate, self.clock_check_callback)

    def parameter_callback(self, params):
        # 먼저 전부 검사하고, 그 다음에 적용
        for param in params:
            if param.name == 'publish_rate':
                problem = self.check_rate(param.value)
                if problem:
                    self.get_logger().warn(problem)
                    return rclpy.node.SetParametersResult(successful=False, reason=problem)
        self.get_logger().info('Updating parameters dynamically...')
        self.update_config(params)
        return rclpy.node.SetParametersResult(successful=True)

    def clock_check_callback(self):
        if not self.enabled:
            return
        if self.is_robot_busy:
            self.get_logger().warn('robot is busy', throttle_duration_sec=5.0)
        self.trigger_patrol(f'{self.mode} mode')

    def trigger_patrol(self, reason):
        msg = String()
        msg.data = f'{self.prefix} {self.seq}'
        self.publisher_.publish(msg)
        self.seq += 1
        self.get_logger().info(f'[{reason}] {msg.data} at {time.strftime("%H:%M:%S", time.localtime())}')

    def manual_trigger_callback(self, request, response):
        self.get_logger().info('Manual trigger received.')
        self.trigger_patrol('Manual trigger via UI')
        response.success = True
        response.message = 'sent'
        return response


def main(args=None):
    rclpy.init(args=args)
    patrol_scheduler = PatrolScheduler()
    try:
        rclpy.spin(patrol_scheduler)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        patrol_scheduler.destroy_node()
        rclpy.try_shutdown()


if __name__ == '__main__':
    main()
