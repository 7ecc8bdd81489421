"""Interface packages as they lie in a workspace: which are found, and what keeps one from being built."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.interfaces.packages import write_package
from tutor.interfaces.cmake_lists import read_cmake_lists
from tutor.interfaces.package import InterfacePackage, KnownTypes, find_packages, problems_of

CALL = "find_package(rosidl_default_generators REQUIRED)\nproject(bell)\n"


def _only(workspace: Path) -> InterfacePackage:
    (package,) = find_packages(workspace)
    return package


def _reasons(workspace: Path, shares: dict[str, Path] | None = None) -> list[str]:
    package = _only(workspace)
    return [problem.reason for problem in problems_of(package, KnownTypes(package, shares or {}, [package.name]))]


@pytest.mark.parametrize(
    "text",
    [
        'rosidl_generate_interfaces(${PROJECT_NAME} "msg/A.msg" "srv/B.srv" DEPENDENCIES std_msgs)',
        "rosidl_generate_interfaces(bell # all\n  msg/A.msg\n  srv/B.srv\n  DEPENDENCIES std_msgs LIBRARY_NAME x)",
        'set(files "msg/A.msg;srv/B.srv")\nrosidl_generate_interfaces(bell ${files} DEPENDENCIES std_msgs)',
        "set(m msg/A.msg)\nlist(APPEND m srv/B.srv)\nROSIDL_GENERATE_INTERFACES(bell ${m} DEPENDENCIES std_msgs)",
        '#[[ rosidl_generate_interfaces(old "x.msg") ]]\n'
        'rosidl_generate_interfaces(bell "./msg/A.msg" ${CMAKE_CURRENT_SOURCE_DIR}/srv/B.srv DEPENDENCIES std_msgs)',
    ],
)
def test_the_files_are_read_from_cmakelists_however_they_are_spelled(text: str) -> None:
    read = read_cmake_lists(CALL + text)
    assert (read.files, read.dependencies, read.project) == (("msg/A.msg", "srv/B.srv"), ("std_msgs",), "bell")


def test_globbed_files_are_all_there_are(tmp_path: Path) -> None:
    folder = write_package(tmp_path, {"msg/A.msg": "int32 a\n", "msg/B.msg": "int32 b\n"})
    text = (folder / "CMakeLists.txt").read_text().replace('"msg/A.msg" "msg/B.msg"', "${found}")
    (folder / "CMakeLists.txt").write_text(f'file(GLOB found RELATIVE . "msg/*.msg")\n{text}')
    assert _only(tmp_path).files == ("msg/A.msg", "msg/B.msg")


def test_a_good_package_has_no_problems(tmp_path: Path) -> None:
    write_package(tmp_path, {"msg/A.msg": "int32 a\n", "srv/B.srv": "A a\n---\n"})
    assert _reasons(tmp_path) == []


@pytest.mark.parametrize(
    "finds",
    [
        "foreach(name rosidl_default_generators std_msgs)\n  find_package(${name} REQUIRED)\nendforeach()",
        "set(names std_msgs)\nforeach(name IN LISTS names ITEMS rosidl_default_generators)\n"
        "  find_package(${name} REQUIRED)\nendforeach()",
        "find_package(ament_cmake_auto REQUIRED)\nament_auto_find_build_dependencies()",
    ],
)
def test_packages_may_be_found_in_a_loop_or_all_that_the_manifest_names(tmp_path: Path, finds: str) -> None:
    folder = write_package(tmp_path, {"msg/A.msg": "int32 a\n"}, dependencies=["std_msgs"])
    cmake, manifest = folder / "CMakeLists.txt", folder / "package.xml"
    old = "find_package(rosidl_default_generators REQUIRED)\nfind_package(std_msgs REQUIRED)"
    text = cmake.read_text()
    assert old in text
    cmake.write_text(text.replace(old, finds))
    shares = {"std_msgs": tmp_path}
    if "auto" in finds:
        assert _reasons(tmp_path, shares) == [
            "rosidl_generate_interfaces() needs find_package(std_msgs REQUIRED) before it"
        ]
        manifest.write_text(manifest.read_text().replace("<exec_depend>", "<depend>std_msgs</depend><exec_depend>", 1))
    assert _reasons(tmp_path, shares) == []


def test_a_file_that_is_not_listed_is_known_and_cannot_be_used(tmp_path: Path) -> None:
    write_package(tmp_path, {"msg/A.msg": "B b\n", "msg/B.msg": "int32 b\n"}, listed=["msg/A.msg"])
    assert _only(tmp_path).unlisted == ("msg/B.msg",)
    assert _reasons(tmp_path) == ["msg/B.msg is not listed in rosidl_generate_interfaces() of CMakeLists.txt"]


def test_a_listed_file_that_is_not_there_is_said(tmp_path: Path) -> None:
    write_package(tmp_path, {"msg/Bell.msg": "int32 b\n"}, listed=["msg/Bel.msg"])
    assert _reasons(tmp_path) == ["msg/Bel.msg is listed, and there is no such file; is it msg/Bell.msg?"]


def test_a_dependency_must_be_named(tmp_path: Path) -> None:
    share = tmp_path / "share" / "std_msgs"
    (share / "msg").mkdir(parents=True)
    (share / "msg" / "Header.idl").touch()
    write_package(tmp_path, {"msg/A.msg": "std_msgs/Header header\n"})
    (reason,) = _reasons(tmp_path, {"std_msgs": share})
    assert reason.startswith("a type of std_msgs needs DEPENDENCIES std_msgs")


@pytest.mark.parametrize(
    ("file", "old", "new", "says"),
    [
        ("package.xml", "<member_of_group>rosidl_interface_packages</member_of_group>", "", "<member_of_group>"),
        ("CMakeLists.txt", "find_package(rosidl_default_generators REQUIRED)", "", "find_package(rosidl_default"),
        ("CMakeLists.txt", "project(bell_interfaces)", "project(bells)", "project() must name the package"),
        ("CMakeLists.txt", "rosidl_generate_interfaces", "message", "is not called"),
        ("CMakeLists.txt", '"msg/A.msg"', "", "names no .msg, .srv or .action file"),
        ("package.xml", "ament_cmake</build_type>", "ament_python</build_type>", "a package of type ament_python"),
    ],
)
def test_what_colcon_would_refuse_is_refused_in_words(tmp_path: Path, file: str, old: str, new: str, says: str) -> None:
    folder = write_package(tmp_path, {"msg/A.msg": "int32 a\n"})
    text = (folder / file).read_text()
    assert old in text
    (folder / file).write_text(text.replace(old, new))
    assert any(says in reason for reason in _reasons(tmp_path))


def test_packages_are_found_as_colcon_finds_them(tmp_path: Path) -> None:
    write_package(tmp_path / "src" / "group", {"msg/A.msg": "int32 a\n"}, name="deep")
    ignored = write_package(tmp_path, {"msg/A.msg": "int32 a\n"}, name="ignored")
    (ignored / "COLCON_IGNORE").touch()
    write_package(tmp_path / "build", {"msg/A.msg": "int32 a\n"}, name="output")
    assert [package.name for package in find_packages(tmp_path)] == ["deep"]


def test_a_name_is_no_way_out_of_the_cache(tmp_path: Path) -> None:
    folder = write_package(tmp_path, {"msg/A.msg": "int32 a\n"})
    manifest = folder / "package.xml"
    manifest.write_text(manifest.read_text().replace("<name>bell_interfaces<", "<name>../../Bells<"))
    assert _only(tmp_path).name == "bell_interfaces"
    assert _reasons(tmp_path) == ["the name of an interface package is in lower_snake_case, and '../../Bells' is not"]


def test_only_files_of_the_package_are_read(tmp_path: Path) -> None:
    write_package(tmp_path, {"msg/A.msg": "int32 a\n"}, listed=["msg/A.msg", "../../../dev/zero.msg"])
    (reason,) = _reasons(tmp_path)
    assert "must lie in the folder msg" in reason
