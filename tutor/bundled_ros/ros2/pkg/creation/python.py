"""The files of an ament_python package."""

from __future__ import annotations

import ast
import warnings
from collections.abc import Iterator

from tutor.bundled_ros.ros2.pkg.creation.new_package import Entry, File, Folder, NewPackage

_SETUP_PY = """\
from setuptools import find_packages, setup

package_name = '{name}'

setup(
    name=package_name,
    version='{version}',
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/ament_index/resource_index/packages',
            ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    maintainer='{maintainer}',
    maintainer_email='{email}',
    description='{description}',
    license='{license}',
    tests_require=['pytest'],
    entry_points={{
        'console_scripts': [
{programs}\
        ],
    }},
)
"""

_SETUP_CFG = """\
[develop]
script_dir=$base/lib/{name}
[install]
install_scripts=$base/lib/{name}
"""

_NODE = """\
def main():
    print('Hi from {name}.')


if __name__ == '__main__':
    main()
"""

_TEST_HEADER = """\
# Copyright {year} Open Source Robotics Foundation, Inc.
#
# Licensed under the Apache License, Version 2.0 (the "License");
# you may not use this file except in compliance with the License.
# You may obtain a copy of the License at
#
#     http://www.apache.org/licenses/LICENSE-2.0
#
# Unless required by applicable law or agreed to in writing, software
# distributed under the License is distributed on an "AS IS" BASIS,
# WITHOUT WARRANTIES OR CONDITIONS OF ANY KIND, either express or implied.
# See the License for the specific language governing permissions and
# limitations under the License.

"""

_TESTS = {
    "test_copyright.py": _TEST_HEADER.format(year=2015)
    + """\
from ament_copyright.main import main
import pytest


# Remove the `skip` decorator once the source file(s) have a copyright header
@pytest.mark.skip(reason='No copyright header has been placed in the generated source file.')
@pytest.mark.copyright
@pytest.mark.linter
def test_copyright():
    rc = main(argv=['.', 'test'])
    assert rc == 0, 'Found errors'
""",
    "test_flake8.py": _TEST_HEADER.format(year=2017)
    + """\
from ament_flake8.main import main_with_errors
import pytest


@pytest.mark.flake8
@pytest.mark.linter
def test_flake8():
    rc, errors = main_with_errors(argv=[])
    assert rc == 0, \\
        'Found %d code style errors / warnings:\\n' % len(errors) + \\
        '\\n'.join(errors)
""",
    "test_pep257.py": _TEST_HEADER.format(year=2015)
    + """\
from ament_pep257.main import main
import pytest


@pytest.mark.linter
@pytest.mark.pep257
def test_pep257():
    rc = main(argv=['.', 'test'])
    assert rc == 0, 'Found code style errors / warnings'
""",
}


def files(package: NewPackage) -> Iterator[Entry]:
    """Yield everything but package.xml and the folder of the modules."""
    name = package.name
    yield File("setup.py", _setup_py(package))
    yield File("setup.cfg", _SETUP_CFG.format(name=name))
    yield Folder("resource")
    yield File(f"resource/{name}", "")
    yield File(f"{name}/__init__.py", "")
    yield Folder("test")
    for test, text in _TESTS.items():
        yield File(f"test/{test}", text)
    if package.node:
        yield File(f"{name}/{package.node}.py", _NODE.format(name=name))
    if package.library:
        yield Folder(f"{name}/{package.library}")
        yield File(f"{name}/{package.library}/__init__.py", "")


def _setup_py(package: NewPackage) -> str:
    node = package.node
    return _SETUP_PY.format(
        name=package.name,
        version=package.version,
        maintainer=_escape(package.maintainer),
        email=_escape(package.email),
        description=_escape(package.description),
        license=_escape(package.license),
        programs=f"            '{node} = {package.name}.{node}:main'\n" if node else "",
    )


def _escape(text: str) -> str:
    """Return the text as it is where quotes can hold it so, as the real `ros2` does; else with its signs escaped."""
    try:
        with warnings.catch_warnings(action="ignore"):
            sound = isinstance(ast.literal_eval(f"'{text}'"), str)
    except (SyntaxError, ValueError):
        sound = False
    if not sound:
        text = text.replace("\\", "\\\\").replace("'", "\\'").replace("\n", "\\n").replace("\r", "\\r")
    return text
