import rclpy
from rclpy.node import Node
from rcl_interfaces.msg import SetParametersResult
from std_msgs.msg import String


class ParamPublisherNode(Node):

    def __init__(self):
        super().__init__('parameterized_publisher')

        # -----------------------------------------------------------
        # 1. 파라미터 선언 및 예외 검사 (0 이하 방어)
        # -----------------------------------------------------------
        self.declare_parameter('message_prefix', 'Hello')
        self.declare_parameter('publish_rate', 1.0)
        self.declare_parameter('enabled', True)

        input_rate = self.get_parameter('publish_rate').value
        if input_rate <= 0.0:
            self.get_logger().warn(
                f'잘못된 publish_rate({input_rate})가 입력되었습니다! 기본값 1.0Hz를 적용합니다.'
            )
            self.publish_rate = 1.0
        else:
            self.publish_rate = float(input_rate)

        # 런타임에 파라미터가 바뀔 때를 대비한 콜백 등록
        self.add_on_set_parameters_callback(self.parameter_callback)

        # -----------------------------------------------------------
        # 2. 퍼블리셔, 타이머 설정
        # -----------------------------------------------------------
        self.pub = self.create_publisher(String, 'chatter', 10)
        self.seq = 0

        # ZeroDivisionError 없이 안전하게 타이머 생성
        self.timer = self.create_timer(1.0 / self.publish_rate, self.publish_text)

    def parameter_callback(self, params):
        """실행 중 ros2 param set 으로 들어오는 잘못된 값 방어"""
        for param in params:
            if param.name == 'publish_rate':
                if param.value <= 0.0:
                    self.get_logger().error(
                        f'파라미터 거부: publish_rate는 0보다 커야 합니다 (입력값: {param.value}).'
                    )
                    return SetParametersResult(
                        successful=False, reason='publish_rate must be > 0'
                    )

                self.publish_rate = float(param.value)
                # 주기 단위 변환
                self.timer.timer_period_ns = int(
                    (1.0 / self.publish_rate) * 1_000_000
                )
                self.get_logger().info(
                    f'발행 주기가 {self.publish_rate}Hz로 성공적으로 변경되었습니다.'
                )

        return SetParametersResult(successful=True)

    def publish_text(self):
        if not self.get_parameter('enabled').value:
            self.get_logger().warn(
                'enabled=false 이므로 발행을 건너뜁니다.',
                throttle_duration_sec=2.0,
            )
            return

        prefix = self.get_parameter('message_prefix').value
        self.pub.publish(String(data=f'{prefix} {self.seq}'))
        self.seq += 1


def main(args=None):
    rclpy.init(args=args)
    node = ParamPublisherNode()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        if rclpy.ok():
            rclpy.shutdown()


if __name__ == '__main__':
    main()
