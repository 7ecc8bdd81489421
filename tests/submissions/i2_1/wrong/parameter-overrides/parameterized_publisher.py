import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.parameter import Parameter
from rcl_interfaces.msg import SetParametersResult
from std_msgs.msg import String

# name -> value the node comes up with
START = dict(message_prefix='Hello', publish_rate=1.0, enabled=True)


def main():
    rclpy.init()
    node = rclpy.create_node(
        'parameterized_publisher',
        parameter_overrides=[Parameter(k, value=v) for k, v in START.items()],
        automatically_declare_parameters_from_overrides=True,
    )
    log = node.get_logger()
    pub = node.create_publisher(String, 'chatter', 10)
    state = {'n': 0, 'timer': None}

    def get(name):
        return node.get_parameter(name).value

    def tick():
        if get('enabled'):
            text = f"{get('message_prefix')} #{state['n']}"
            pub.publish(String(data=text))
            log.info(f'Published: {text}')
            state['n'] += 1

    def restart():
        if state['timer'] is not None:
            node.destroy_timer(state['timer'])
        state['timer'] = node.create_timer(1 / get('publish_rate'), tick)

    def ok(params):
        bad = [p.value for p in params if p.name == 'publish_rate' and not p.value > 0]
        if bad:
            return SetParametersResult(successful=False, reason=f'publish_rate must be > 0 Hz, not {bad[0]}')
        return SetParametersResult(successful=True)

    def changed(params):
        if 'publish_rate' in [p.name for p in params]:
            restart()

    if get('publish_rate') <= 0:
        log.fatal(f"bad publish_rate: {get('publish_rate')}")
        rclpy.try_shutdown()
        return 1

    restart()
    node.add_on_set_parameters_callback(ok)
    node.add_post_set_parameters_callback(changed)

    try:
        rclpy.spin(node)
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()
    return 0


if __name__ == '__main__':
    raise SystemExit(main())
