"""The bundled `ros2`: see `starting.ros2_command`."""

import signal
import sys

try:
    from tutor.interpreter import reduce_gc_frequency, unblock_sigint

    unblock_sigint()
    reduce_gc_frequency()
    from tutor.bundled_ros.ros2.command import main

    sys.exit(main(sys.argv[1:]))
except KeyboardInterrupt:  # Ctrl+C during the imports
    sys.exit(int(signal.SIGINT))
