"""`ros2 daemon`: a stub, since no daemon is needed. It keeps scripts working that start, stop or query the daemon."""

VERBS = {
    "start": "Do nothing: no daemon is needed",
    "status": "Say that the daemon is not running",
    "stop": "Do nothing: no daemon is running",
}
