"""Removes the folder that it is in."""

import os
import shutil

shutil.rmtree(os.path.dirname(os.path.abspath(__file__)))
