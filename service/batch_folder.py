"""The folder of a rendered sequence: which frames are in it, and what it is a folder of."""

from __future__ import annotations

import contextlib
import errno
import fcntl
import json
import os
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import pydantic

from crystal_core import sequence
from crystal_core.errors import InputError
from crystal_core.output.files import PART_SUFFIX, file_digest, write_atomically

__all__ = ["FILM", "MANIFEST", "BatchFolder", "frame_name", "open_batch_folder", "unusable_reason"]

MANIFEST = "manifest.json"
FILM = "sequence.webp"

_OUT = "--out"

_DISK_FAULTS = {errno.ENOSPC, errno.EDQUOT, errno.EIO}
"""Not the fault of who named the folder."""

_NO_LOCKS = {errno.EBADF, errno.ENOLCK, errno.EOPNOTSUPP, errno.ENOSYS, errno.EINVAL}
"""What file systems say that lock no folders."""


def frame_name(index: int) -> str:
    """Return the file name of a frame."""
    return f"frame-{index:04d}.png"


class _Film(pydantic.BaseModel):
    file: str
    sha256: str


class _Stored(pydantic.BaseModel):
    """What a later run needs of a manifest."""

    request_digest: str
    frames: list[sequence.FrameRecord]
    complete: bool
    animation: _Film | None = None


class BatchFolder:
    """A folder that is being filled; made by `open_batch_folder`.

    Every file in it is whole at all times, and the manifest names only frames that are there.

    Parameters
    ----------
    path : Path
        The folder, which exists.
    request : RenderRequest
        What it is a folder of.
    """

    def __init__(self, path: Path, request: sequence.RenderRequest) -> None:
        self.path = path
        self.request = request
        self.complete = False
        self._records: dict[int, sequence.FrameRecord] = {}

    @property
    def missing(self) -> list[int]:
        """Indices of the frames that are not there yet."""
        return [index for index in range(self.request.frames) if index not in self._records]

    def add_frame(
        self, index: int, png: bytes, *, seconds: float, error_estimate: float, clipped_fraction: float
    ) -> None:
        """Write a frame, and a manifest that names it.

        Parameters
        ----------
        index : int
            Which frame.
        png : bytes
            The file.
        seconds : float
            Work it took.
        error_estimate : float
            Estimated RMS error, linear sRGB.
        clipped_fraction : float
            Part of the pixels that the gamut rule changed.

        Raises
        ------
        OSError
            The disk is full or not writable; the folder is as it was.
        """
        name = frame_name(index)
        self._records[index] = sequence.FrameRecord(
            index=index,
            angle_deg=sequence.frame_angle_deg(self.request, index),
            file=name,
            sha256=write_atomically(self.path / name, png),
            seconds=seconds,
            error_estimate=error_estimate,
            clipped_fraction=clipped_fraction,
        )
        self.write_manifest()

    def read_frame(self, index: int) -> bytes:
        """Return the file of a frame that is there.

        Raises
        ------
        OSError
            It cannot be read.
        """
        return (self.path / self._records[index].file).read_bytes()

    def finish(self, film: bytes, frame_ms: int) -> None:
        """Write the animation, and the manifest of the finished sequence.

        Parameters
        ----------
        film : bytes
            The animation.
        frame_ms : int
            How long each of its pictures stands, ms.

        Raises
        ------
        OSError
            The disk is full or not writable.
        """
        digest = write_atomically(self.path / FILM, film)
        self.complete = True
        self.write_manifest({"file": FILM, "sha256": digest, "frame_ms": frame_ms})

    def write_manifest(self, film: Mapping[str, Any] | None = None) -> None:
        """Write the manifest of what is there.

        Raises
        ------
        OSError
            The disk is full or not writable.
        """
        manifest = sequence.manifest(self.request, list(self._records.values()), self.complete)
        manifest["animation"] = film
        text = json.dumps(manifest, indent=2, ensure_ascii=False)
        write_atomically(self.path / MANIFEST, f"{text}\n".encode())

    def take_up(self, stored: bytes, keep_on: Callable[[], None]) -> None:
        """Go on from a manifest of this request: keep the frames that are as it says.

        Parameters
        ----------
        stored : bytes
            The manifest in the folder.
        keep_on : callable
            Called before each file is read; raises to stop.

        Raises
        ------
        InputError
            The manifest is of another request, or none of ours.
        """
        before = self._parse(stored)
        for record in before.frames:
            keep_on()
            ours = record.index in range(self.request.frames) and record.file == frame_name(record.index)
            if ours and self._holds(record.file, record.sha256):
                self._records[record.index] = record
        film = before.animation
        self.complete = (
            before.complete
            and not self.missing
            and film is not None
            and film.file == FILM
            and self._holds(FILM, film.sha256)
        )

    def sweep(self) -> None:
        """Remove what the manifest does not vouch for: damaged frames, a film of them, what a killed run left.

        Raises
        ------
        OSError
            The folder is not writable.
        """
        for index in self.missing:
            (self.path / frame_name(index)).unlink(missing_ok=True)
        if self.missing:
            (self.path / FILM).unlink(missing_ok=True)
        for name in ("frame-*.png", FILM, MANIFEST):
            for leftover in self.path.glob(f".{name}.*{PART_SUFFIX}"):
                leftover.unlink(missing_ok=True)

    def _holds(self, name: str, sha256: str) -> bool:
        try:
            return file_digest(self.path / name) == sha256
        except OSError:
            return False  # missing or unreadable: it is made again

    def _parse(self, stored: bytes) -> _Stored:
        try:
            told = json.loads(stored)
            before = _Stored.model_validate(told)
        except (ValueError, RecursionError) as error:
            raise InputError.at(_OUT, f"{self.path / MANIFEST} is no manifest of a sequence") from error
        if before.request_digest != self.request.digest():
            other = _differences(told, sequence.manifest(self.request, [], False))
            raise InputError.at(_OUT, f"{self.path} holds another sequence ({other}); give another folder")
        return before


@contextlib.contextmanager
def open_batch_folder(
    path: Path, request: sequence.RenderRequest, keep_on: Callable[[], None]
) -> Iterator[BatchFolder]:
    """Make the folder of a sequence, or take it up where an earlier run left it.

    As long as the context lasts no other process can open the folder.

    Parameters
    ----------
    path : Path
        The folder; it and those above it are made if need be.
    request : RenderRequest
        What is to be rendered.
    keep_on : callable
        Called now and then; raises to stop.

    Yields
    ------
    BatchFolder
        Its manifest is on the disk and says what is there.

    Raises
    ------
    InputError
        The folder cannot be made or written to, is in use, or holds something else; it has not been touched.
    OSError
        The disk is full or broken.
    """
    made: list[Path] = []
    descriptor = -1
    try:
        try:
            _make(path, made)
            descriptor = os.open(path, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
            _lock(descriptor, path)
            folder = _take(path, request, keep_on)
            if not folder.complete:
                folder.sweep()
                folder.write_manifest()  # last: whatever fails before it leaves no trace of a new folder
        except BaseException as error:
            for new in reversed(made):
                with contextlib.suppress(OSError):  # something else has come into it
                    new.rmdir()
            if isinstance(error, OSError) and error.errno not in _DISK_FAULTS:
                raise InputError.at(_OUT, f"{path} cannot be written to: {error.strerror}") from error
            raise
        yield folder
    finally:
        if descriptor >= 0:
            os.close(descriptor)


def unusable_reason(path: Path) -> str | None:
    """Return why a folder can be neither made nor used at a path, as far as can be told without touching anything."""
    for place in (path, *path.parents):
        try:
            if place.is_dir():
                return None if os.access(place, os.W_OK | os.X_OK) else f"{place} is not writable"
            if place.exists() or place.is_symlink():
                return f"{place} is not a folder"
        except OSError as error:
            return f"{path} cannot be used: {error.strerror}"
    return f"{path} cannot be made"


def _make(path: Path, made: list[Path]) -> None:
    """Make a folder and those above it, and note the new ones."""
    if path.is_dir():
        return
    if path.parent != path:
        _make(path.parent, made)
    path.mkdir()
    made.append(path)


def _lock(descriptor: int, path: Path) -> None:
    """Hold the folder itself, so that no lock file lies about; the lock goes with the process, however it ends."""
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise InputError.at(_OUT, f"{path} is being filled by another isogyre") from None
    except OSError as error:
        # Some network file systems lock no folders. Two runs then do each other's work twice, but spoil nothing: files
        # appear whole, and one request has one answer.
        if error.errno not in _NO_LOCKS:
            raise


def _take(path: Path, request: sequence.RenderRequest, keep_on: Callable[[], None]) -> BatchFolder:
    folder = BatchFolder(path, request)
    try:
        stored = (path / MANIFEST).read_bytes()
    except FileNotFoundError:
        taken = [frame_name(index) for index in range(request.frames)] + [FILM]
        for name in taken:
            if os.path.lexists(path / name):
                raise InputError.at(
                    _OUT, f"{path} holds {name} but no {MANIFEST}: its files would be lost; give another folder"
                ) from None
        return folder
    folder.take_up(stored, keep_on)
    return folder


def _differences(before: Mapping[str, Any], now: Mapping[str, Any]) -> str:
    """Return in which of its parts another manifest's request is another one."""
    names = [key for key in ("demonstration", "seed", "size", "quality") if before.get(key) != now.get(key)]
    if before.get("frame_count") != now["frame_count"]:
        names.append("frames")
    for part in ("parameters", "document"):  # of a demonstration, of a scene
        old, new = before.get(part), now.get(part)
        if isinstance(old, Mapping) and isinstance(new, Mapping):
            names += sorted(key for key in {*old, *new} if old.get(key) != new.get(key))
        elif old != new and "demonstration" not in names:
            names.append(part)
    if not names:
        return "the same request, answered by another version of isogyre or of its mineral data"
    return f"{', '.join(names)} {'differs' if len(names) == 1 else 'differ'}"
