"""Sends SIGTERM to the process that started it."""

import os
import signal
import time

os.kill(os.getppid(), signal.SIGTERM)
time.sleep(100)
