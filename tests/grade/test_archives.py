"""Archives of any kind are unpacked or refused with a reason; nothing gets out of its folder, or takes for ever."""

from __future__ import annotations

import io
import os
import random
import stat
import struct
import subprocess
import tarfile
import tempfile
import zipfile
from contextlib import suppress
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tutor.grade.archives import WHOLE_CLASS, BadArchive, Limits, is_archive, stem, unpack
from tutor.grade.submission_files import digest_of, files_below, is_own_file, pack, unpack_packed

SMALL = Limits(20, 2 << 20)


def zip_of(path: Path, files: dict[str, bytes]) -> Path:
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return path


def tar_of(path: Path, files: dict[str, bytes], mode: str = "w:gz") -> Path:
    with tarfile.open(path, mode) as archive:  # type: ignore[call-overload]
        for name, content in files.items():
            entry = tarfile.TarInfo(name)
            entry.size = len(content)
            archive.addfile(entry, io.BytesIO(content))
    return path


def unpacked(archive: Path, limits: Limits = SMALL) -> dict[str, bytes]:
    """Unpack, and return the files by their path; nothing else may have been written."""
    top = archive.parent / "top"
    folder = top / "folder"
    folder.mkdir(parents=True)
    unpack(archive, folder, limits)
    assert os.listdir(top) == ["folder"]
    assert not any(path.is_symlink() for path in folder.rglob("*"))
    return {str(path.relative_to(folder)): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


FILES = {"a.py": b"a", "deep/er/b.py": b"b", "weird 🤖\u202e\x1b.py": b"c", "umlaut-ü.py": b"d"}


@pytest.mark.parametrize("name", ["x.zip", "X.ZIP", "x.tar", "x.tar.gz", "x.tgz", "x.tar.xz", "x.tar.bz2"])
def test_every_kind_is_unpacked(tmp_path: Path, name: str) -> None:
    kind = name.lower().rpartition(".")[2].replace("tgz", "gz").replace("tar", "")
    archive = tmp_path / name
    made = zip_of(archive, FILES) if kind == "zip" else tar_of(archive, FILES, f"w:{kind}")
    assert is_archive(made)
    assert stem(made).lower() == "x"
    assert unpacked(made) == FILES


@pytest.mark.parametrize("make", [zip_of, tar_of])
def test_names_that_lead_out_or_that_no_file_can_have_are_left_out(tmp_path: Path, make: object) -> None:
    bad = ["../up.py", "a/../../up.py", "/abs.py", "..\\up.py", "\\abs.py", "x" * 300 + ".py", "d/" * 40 + "deep.py"]
    bad += [f"{folder}/x.py" for folder in (".git", "build", "a/install", "__MACOSX", ".venv", "__pycache__")]
    archive = tmp_path / ("x.zip" if make is zip_of else "x.tgz")
    make(archive, {**dict.fromkeys(bad, b""), "good.py": b"1", "back\\slash.py": b"2", "./dot.py": b"3"})  # type: ignore[operator]
    assert unpacked(archive) == {"good.py": b"1", "back/slash.py": b"2", "dot.py": b"3"}


def test_a_name_for_a_file_and_a_folder(tmp_path: Path) -> None:
    assert unpacked(zip_of(tmp_path / "x.zip", {"a": b"1", "a/b.py": b"2", "c/d.py": b"3", "c": b"4"})) == {
        "a": b"1",
        "c/d.py": b"3",
    }


def test_links_and_devices_are_left_out(tmp_path: Path) -> None:
    with tarfile.open(tmp_path / "x.tar", "w") as archive:
        for kind in (tarfile.SYMTYPE, tarfile.LNKTYPE, tarfile.CHRTYPE, tarfile.FIFOTYPE):
            entry = tarfile.TarInfo(f"link{kind.decode()}")
            entry.type, entry.linkname = kind, "/etc"
            archive.addfile(entry)
        entry = tarfile.TarInfo("link2/passwd")  # through the symbolic link, if it were there
        archive.addfile(entry)
    assert unpacked(tmp_path / "x.tar") == {"link2/passwd": b""}
    (tmp_path / "top" / "folder" / "link2" / "passwd").unlink()
    with zipfile.ZipFile(tmp_path / "x.zip", "w") as zipped:
        info = zipfile.ZipInfo("link.py")
        info.external_attr = (stat.S_IFLNK | 0o777) << 16
        zipped.writestr(info, "/etc/passwd")
    unpack(tmp_path / "x.zip", tmp_path / "top" / "folder", SMALL)
    assert not (tmp_path / "top" / "folder" / "link.py").exists()


DAMAGED = "it is damaged, or not an archive of this kind"


@pytest.mark.parametrize(
    ("name", "content", "why"),
    [
        ("x.zip", b"", DAMAGED),
        ("x.zip", b"PK\x03\x04 no", DAMAGED),
        ("x.tar.gz", b"\x1f\x8b no", DAMAGED),
        ("x.tar.xz", b"\xfd7zXZ\x00 no", DAMAGED),
        ("x.tar", b"#!/usr/bin/env python3", DAMAGED),
        ("x.rar", b"Rar!", "it is neither a zip nor a tar file"),
        ("x.7z", b"7z", "it is neither a zip nor a tar file"),
    ],
)
def test_what_is_no_archive(tmp_path: Path, name: str, content: bytes, why: str) -> None:
    archive = tmp_path / name
    archive.write_bytes(content)
    assert is_archive(archive)
    with pytest.raises(BadArchive, match=why):
        unpacked(archive)


def encrypt(archive: Path) -> None:
    """Set the flag of encryption, in both headers: unpacking needs no more to refuse."""
    content = bytearray(archive.read_bytes())
    for signature, place in ((b"PK\x03\x04", 6), (b"PK\x01\x02", 8)):
        content[content.index(signature) + place] |= 1
    archive.write_bytes(bytes(content))


def test_an_encrypted_archive(tmp_path: Path) -> None:
    archive = zip_of(tmp_path / "x.zip", {"a.py": b"print()"})
    encrypt(archive)
    with pytest.raises(BadArchive, match="it is encrypted"):
        unpacked(archive)


def change_headers(archive: Path, layout: str, places: tuple[int, int], value: int) -> None:
    """Write a value into the local and the central header of the only file in a zip."""
    content = bytearray(archive.read_bytes())
    for signature, place in zip((b"PK\x03\x04", b"PK\x01\x02"), places, strict=True):
        struct.pack_into(layout, content, content.index(signature) + place, value)
    archive.write_bytes(bytes(content))


def test_an_unknown_compression(tmp_path: Path) -> None:
    archive = zip_of(tmp_path / "x.zip", {"a.py": b"print()"})
    change_headers(archive, "<H", (8, 10), 97)
    with pytest.raises(BadArchive, match=DAMAGED):
        unpacked(archive)


@pytest.mark.parametrize("make", [zip_of, tar_of])
def test_large_data_is_left_out_but_too_much_code_is_refused(tmp_path: Path, make: object) -> None:
    suffix = ".zip" if make is zip_of else ".tgz"
    data = {"bag.db3": bytes(3 << 20), "some.bin": b"1", "log.txt": bytes(3 << 20), "a.py": b"2"}
    make(tmp_path / f"data{suffix}", data)  # type: ignore[operator]
    assert unpacked(tmp_path / f"data{suffix}") == {"some.bin": b"1", "a.py": b"2"}
    (tmp_path / "code").mkdir()
    make(tmp_path / "code" / f"x{suffix}", {f"{number}.py": b"" for number in range(21)})  # type: ignore[operator]
    with pytest.raises(BadArchive, match="it is too large: more than 20 files or 2 MB"):
        unpacked(tmp_path / "code" / f"x{suffix}")


def test_bombs_take_neither_disk_nor_time(tmp_path: Path) -> None:
    zeros = bytes(1 << 20)
    (tmp_path / "many").mkdir()
    bomb = zip_of(tmp_path / "x.zip", {f"{number}.bin": zeros for number in range(10)})
    assert sum(map(len, unpacked(bomb).values())) <= SMALL.bytes
    # To get past what is left out of a tar file, it has to be decompressed.
    long = tar_of(tmp_path / "many" / "x.tgz", {f"build/{number}": zeros for number in range(40)})
    with pytest.raises(BadArchive, match="it is too large"):
        unpacked(long)


def test_a_size_that_the_archive_lies_about(tmp_path: Path) -> None:
    archive = zip_of(tmp_path / "x.zip", {"a.py": bytes(1 << 20)})
    change_headers(archive, "<I", (22, 24), 10)
    with pytest.raises(BadArchive, match=DAMAGED):
        unpacked(archive)


def test_a_negative_size_does_not_loop_for_ever(tmp_path: Path) -> None:
    entry = tarfile.TarInfo("a.py")
    header = bytearray(entry.tobuf(tarfile.GNU_FORMAT))
    header[124:136] = b"\xff" * 10 + struct.pack(">h", -512)
    header[148:156] = b"%06o\0 " % (sum(header[:148]) + sum(b" " * 8) + sum(header[156:512]))
    (tmp_path / "x.tar").write_bytes(bytes(header) + bytes(1024))
    with pytest.raises(BadArchive, match=DAMAGED):
        unpacked(tmp_path / "x.tar")


def test_a_class_is_unpacked_whole_or_not_at_all(tmp_path: Path) -> None:
    files = {f"learner {number}/data.bin": bytes(1000) for number in range(200)}
    archive = zip_of(tmp_path / "class.zip", files)
    assert len(unpacked(archive, WHOLE_CLASS)) == 200
    (tmp_path / "again").mkdir()
    again = archive.rename(tmp_path / "again" / "class.zip")
    with pytest.raises(BadArchive, match="it is too large"):
        unpacked(again, Limits(199, 1 << 30, all_or_nothing=True))


def test_a_full_disk_is_not_the_archives_fault(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    archive = zip_of(tmp_path / "x.zip", {"a.py": b"1"})
    with pytest.raises(FileNotFoundError):
        unpack(tmp_path / "gone.zip", tmp_path)

    def fail(*_: object, **__: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "mkdir", fail)
    with pytest.raises(OSError, match="No space left"):
        unpack(archive, tmp_path / "folder")


@settings(max_examples=60)
@given(st.sampled_from(["zip", "tar", "tar.gz", "tar.xz", "tar.bz2"]), st.integers(0, 2**32), st.integers(1, 30))
def test_any_damage_is_called_damage(kind: str, seed: int, changes: int) -> None:
    chance = random.Random(seed)
    with tempfile.TemporaryDirectory() as temporary:
        archive = Path(temporary, f"x.{kind}")
        files = {"a.py": b"print()\n" * 50, "b/c.py": chance.randbytes(500), "ü.txt": b""}
        mode = f"w:{kind.partition('.')[2]}"
        content = bytearray((zip_of(archive, files) if kind == "zip" else tar_of(archive, files, mode)).read_bytes())
        for _ in range(changes):
            content[chance.randrange(len(content))] = chance.choice([0, 1, 255, chance.randrange(256)])
        archive.write_bytes(bytes(content[: chance.choice([len(content), chance.randrange(len(content))])]))
        with suppress(BadArchive):
            assert sum(map(len, unpacked(archive).values())) <= SMALL.bytes


# --- packing ---


def test_a_submission_travels_as_it_is(tmp_path: Path) -> None:
    source, target = tmp_path / "source", tmp_path / "target"
    for name, content in FILES.items():
        (source / name).parent.mkdir(parents=True, exist_ok=True)
        (source / name).write_bytes(content)
    (source / "a.py").chmod(0o700)
    files = {name: source / name for name in FILES}
    packed, digest = pack(files)
    assert digest == digest_of(files)
    (source / "a.py").touch()
    assert pack(dict(reversed(files.items()))) == (packed, digest)
    unpack_packed(packed, target)
    assert {str(path.relative_to(target)): path.read_bytes() for path in target.rglob("*") if path.is_file()} == FILES
    assert [stat.S_IMODE((target / name).stat().st_mode) for name in ("a.py", "deep/er/b.py")] == [0o755, 0o644]


def test_a_digest_identifies_names_and_contents(tmp_path: Path) -> None:
    for name in ("a", "b"):
        (tmp_path / name).write_bytes(name.encode())
    a, b = tmp_path / "a", tmp_path / "b"
    digests = {digest_of(files) for files in ({"x": a}, {"x": b}, {"y": a}, {"x": a, "y": b}, {"x": b, "y": a}, {})}
    assert len(digests) == 6
    assert digest_of({"x": a, "y": b}) == digest_of({"y": b, "x": a})
    assert digest_of({"\udcff": a}) != digest_of({"\udcfe": a})


def test_what_is_taken_of_a_folder(tmp_path: Path) -> None:
    for name in ("a.py", "b/c.txt", ".git/config", "build/x.py", "b/__pycache__/y.pyc", "z.pyc", "log/x", ".venv/v.py"):
        (tmp_path / "own" / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "own" / name).write_text("")
    own = tmp_path / "own"
    (tmp_path / "secret.py").write_text("")
    (own / "out.py").symlink_to("../secret.py")
    (own / "in.py").symlink_to("a.py")
    (own / "loop.py").symlink_to("loop.py")
    (own / "home").symlink_to(tmp_path)
    os.mkfifo(own / "fifo.py")
    (own / os.fsdecode(b"latin-\xfc.py")).write_text("")
    deep = own.joinpath(*["d"] * 31)
    deep.mkdir(parents=True)
    (deep / "x.py").write_text("")
    assert sorted(files_below(own, own)) == ["a.py", "b/c.txt", "in.py"]
    assert not is_own_file(own / "fifo.py", own)


def test_only_code_is_taken_of_a_folder_that_is_too_large(tmp_path: Path) -> None:
    (tmp_path / "big.bin").write_bytes(bytes(3 << 20))
    (tmp_path / "big.py").write_bytes(bytes(3 << 20))
    (tmp_path / "a.py").write_text("")
    assert sorted(files_below(tmp_path, tmp_path, Limits(20, 4 << 20))) == ["a.py"]
    assert sorted(files_below(tmp_path, tmp_path, Limits(20, 7 << 20))) == ["a.py", "big.bin", "big.py"]
    for number in range(30):
        (tmp_path / f"{number}").mkdir()
        (tmp_path / f"{number}" / "b.py").write_text("")
    taken = files_below(tmp_path, tmp_path, Limits(20, 4 << 20))
    assert "a.py" in taken
    assert len(taken) + len({Path(name).parent for name in taken}) <= 20


@pytest.mark.skipif(os.getuid() == 0, reason="root may read everything")
def test_a_folder_that_cannot_be_read(tmp_path: Path) -> None:
    (tmp_path / "closed").mkdir(mode=0)
    with pytest.raises(PermissionError):
        files_below(tmp_path, tmp_path)


def test_the_archive_of_another_program(tmp_path: Path) -> None:
    (tmp_path / "a.py").write_text("1")
    subprocess.run(["tar", "--create", "--gzip", "--file", "x.tar.gz", "a.py"], cwd=tmp_path, check=True)
    assert unpacked(tmp_path / "x.tar.gz") == {"a.py": b"1"}
