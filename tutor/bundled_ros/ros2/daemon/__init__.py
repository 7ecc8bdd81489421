"""`ros2 daemon`: there is none, and none is needed; scripts that start, stop or ask for one go on."""

VERBS = {
    "start": "Do nothing: no daemon is needed",
    "status": "Say that the daemon is not running",
    "stop": "Do nothing: no daemon is running",
}
