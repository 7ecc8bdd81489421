import threading

import rclpy
from example_interfaces.action import Fibonacci
from rclpy.action import ActionServer
from rclpy.action.server import CancelResponse, GoalResponse
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup
from rclpy.executors import MultiThreadedExecutor

lock = threading.Lock()
stops = {}


def make_stop(goal_handle):
    with lock:
        for stop in stops.values():
            stop.set()
        stops[bytes(goal_handle.goal_id.uuid)] = threading.Event()
    goal_handle.execute()


def cancel(goal_handle):
    stops[bytes(goal_handle.goal_id.uuid)].set()
    return CancelResponse.ACCEPT


def count(goal_handle):
    key = bytes(goal_handle.goal_id.uuid)
    stop, numbers = stops[key], []
    for n in reversed(range(goal_handle.request.order + 1)):
        numbers += [n]
        goal_handle.publish_feedback(Fibonacci.Feedback(sequence=numbers))
        if n and stop.wait(0.25):
            break
    with lock:
        stops.pop(key, None)
    if not rclpy.ok():
        return Fibonacci.Result()
    if numbers[-1] == 0:
        goal_handle.succeed()
    else:
        # the flag is set just after the cancel callback has returned
        for _ in range(20):
            if goal_handle.is_cancel_requested:
                goal_handle.canceled()
                break
            threading.Event().wait(0.01)
        else:
            goal_handle.abort()
    return Fibonacci.Result(sequence=numbers)


if __name__ == "__main__":
    rclpy.init()
    node = rclpy.create_node("countdown_functions")
    server = ActionServer(
        node, Fibonacci, "countdown", count,
        callback_group=MutuallyExclusiveCallbackGroup(),
        goal_callback=lambda g: (GoalResponse.REJECT, GoalResponse.ACCEPT)[g.order >= 0],
        handle_accepted_callback=make_stop, cancel_callback=cancel)
    pool = MultiThreadedExecutor(8)
    pool.add_node(node)
    try:
        pool.spin()
    except (KeyboardInterrupt, rclpy.executors.ExternalShutdownException):
        pass
    finally:
        for event in list(stops.values()):
            event.set()
        rclpy.try_shutdown()
