import rclpy
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


class VoiceCalculatorNode(Node):
    """Cálculos para el asistente de voz."""

    OPERATIONS = (
        ("add", "más"),
        ("subtract", "menos"),
        ("multiply", "por"),
        ("divide", "entre"),
    )

    def __init__(self):
        super().__init__("voice_calculator")
        self.log = self.get_logger()
        self.handlers_ = [
            self.create_service(AddTwoInts, name, lambda rq, rs, n=name, w=word: self.on_request(n, w, rq, rs))
            for name, word in self.OPERATIONS
        ]
        self.log.info("voice calculator ready")

    def on_request(self, name, word, rq, rs):
        try:
            rs.sum = getattr(self, "do_" + name)(rq.a, rq.b)
            self.log.info(f"{rq.a} {word} {rq.b} son {rs.sum}")
        except Exception as e:
            self.log.error(f"Error processing {name} request: {e}", exc_info=True)
            rs.sum = 0
        return rs

    def do_add(self, a, b):
        return a + b

    def do_subtract(self, a, b):
        return a - b

    def do_multiply(self, a, b):
        return a * b

    def do_divide(self, a, b):
        return a // b


def main(args=None):
    rclpy.init(args=args)
    node = VoiceCalculatorNode()
    try:
        rclpy.spin(node)
    except KeyboardInterrupt:
        pass
    finally:
        node.destroy_node()
        rclpy.try_shutdown()


if __name__ == "__main__":
    main()
