"""A node that answers nothing, and writes stack dumps that name endless files as their source."""

import os
import sys
import threading
import time

import rclpy

FIFO = os.path.join(os.path.dirname(os.path.abspath(__file__)), "fifo")
if not os.path.exists(FIFO):
    os.mkfifo(FIFO)


def forge():
    while True:
        for path in (FIFO, "/dev/zero", __file__):
            print(f'Current thread 0x0000 (most recent call first):\n  File "{path}", line 1 in forged', file=sys.stderr)
        time.sleep(0.01)


rclpy.init()
node = rclpy.create_node("hostile")
import faulthandler
import signal

faulthandler.disable()
threading.Thread(target=forge, daemon=True).start()
signal.signal(signal.SIGABRT, signal.SIG_IGN)
while True:
    time.sleep(1)
