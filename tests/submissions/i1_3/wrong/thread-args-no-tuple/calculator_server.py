"""Calculator brain. Status goes to the terminal every 10 s, ROS runs beside it."""
import threading, time
import rclpy
from rclpy.node import Node
from example_interfaces.srv import AddTwoInts


class CalcBrain(Node):
    def __init__(self):
        super().__init__('calc_brain')
        self.calls = 0; self.last = 'none'
        self.create_service(AddTwoInts, '/add', self._add)
        self.create_service(AddTwoInts, '/subtract', self._sub)
        self.create_service(AddTwoInts, '/multiply', self._mul)
        self.create_service(AddTwoInts, '/divide', self._div)
        self.get_logger().info('🧠 Calc brain online')

    def _done(self, text):
        self.calls += 1; self.last = text
        self.get_logger().info(text)

    def _add(self, q, r):
        r.sum = q.a + q.b; self._done(f'{q.a}+{q.b}={r.sum}'); return r

    def _sub(self, q, r):
        r.sum = q.a - q.b; self._done(f'{q.a}-{q.b}={r.sum}'); return r

    def _mul(self, q, r):
        r.sum = q.a * q.b; self._done(f'{q.a}*{q.b}={r.sum}'); return r

    def _div(self, q, r):
        if q.b == 0:
            self.get_logger().error('❌ division by zero'); r.sum = 0; return r
        r.sum = q.a // q.b; self._done(f'{q.a}/{q.b}={r.sum}'); return r

    def get_status(self):
        return {'calls': self.calls, 'last': self.last}


def main():
    rclpy.init(); brain = CalcBrain()
    threading.Thread(target=rclpy.spin, args=(brain), daemon=True).start()

    print('Calc brain running, Ctrl+C to stop')
    t = time.time()
    try:
        while rclpy.ok():
            time.sleep(0.2)
            if time.time() - t > 10: print(brain.get_status()); t = time.time()
    except KeyboardInterrupt: pass
    brain.destroy_node(); rclpy.try_shutdown()


if __name__ == '__main__': main()
