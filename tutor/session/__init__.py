"""The logic shared by the app, the plain-text dialog and the command line, so that they cannot disagree.

Imports neither Textual nor rclpy.
"""

from tutor.session.session import Session

__all__ = ["Session"]
