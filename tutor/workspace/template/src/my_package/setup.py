from pathlib import Path

from setuptools import find_packages, setup

package_name = "my_package"

# Every module here that has a main() becomes a program: `ros2 run my_package <module>`.
programs = [
    module.stem
    for module in sorted(Path(package_name).glob("*.py"))
    if "def main(" in module.read_text(encoding="utf-8")
]

# Everything in launch/ is installed, so that `ros2 launch my_package <file>` finds it (a name~ is a backup).
launch_files = [
    str(file) for file in sorted(Path("launch").glob("*")) if file.is_file() and not file.name.endswith("~")
]

setup(
    name=package_name,
    version="0.0.0",
    packages=find_packages(exclude=["test"]),
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/" + package_name]),
        ("share/" + package_name, ["package.xml"]),
        ("share/" + package_name + "/launch", launch_files),
    ],
    install_requires=["setuptools"],
    zip_safe=True,
    maintainer="me",
    maintainer_email="me@example.com",
    description="My answers to the ros-tutor exercises",
    license="Apache-2.0",
    entry_points={
        "console_scripts": [f"{program} = {package_name}.{program}:main" for program in programs],
    },
)
