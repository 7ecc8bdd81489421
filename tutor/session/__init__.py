"""What the app, plain text and the command line share: one answer to each question, so that they cannot disagree.

Imports neither Textual nor rclpy.
"""

from tutor.session.session import Session

__all__ = ["Session"]
