"""The file of a scene, as the command line takes it: paths in it are relative to it."""

from __future__ import annotations

import hashlib
from pathlib import Path
from typing import Any

from crystal_core.errors import Fault, InputError, NotSupportedError
from crystal_core.output.files import write_atomically
from crystal_core.scene import SceneDocument, SceneFiles, StagedDocument, read_scene, stage_scene
from crystal_core.scene.scene_files import SUFFIXES

__all__ = ["SceneFile", "is_scene_file"]


def is_scene_file(text: str) -> bool:
    """Tell whether an argument names the file of a scene, and not a demonstration."""
    return text.lower().endswith(SUFFIXES)


class SceneFile:
    """A scene in a file.

    Parameters
    ----------
    file : str
        Its path, as it was typed.

    Raises
    ------
    InputError
        It cannot be read, or holds no scene; each fault is named by the file and its place in the scene.
    """

    def __init__(self, file: str) -> None:
        self.path = Path(file)
        try:
            self.scene: SceneDocument = read_scene(self.path)
        except InputError as error:
            raise self.told(error) from None
        except ValueError as error:  # no name that a file could have
            raise InputError.at("FILE", f"{file!r} cannot be read: {error}") from None

    @property
    def name(self) -> str:
        """How messages call the file: without its folder, whose leading / would look like that of a place in it."""
        return self.path.name

    @property
    def files(self) -> SceneFiles:
        """Where the files are that it names."""
        return SceneFiles(folder=self.path.parent)

    def staged(self) -> StagedDocument:
        """Return the scene put together, all its frames checked.

        Raises
        ------
        InputError, NotSupportedError
            Each fault is named by the file and its place in the scene.
        """
        try:
            return stage_scene(self.scene, self.files)
        except InputError as error:
            raise self.told(error) from None
        except NotSupportedError as error:
            raise NotSupportedError(f"{self.name}: {error}") from None

    def with_assets(self, assets: Path) -> dict[str, Any]:
        """Return the scene as a mapping that names assets only, having put the files that it names among them.

        Parameters
        ----------
        assets : Path
            Folder of the files that a request may name.

        Raises
        ------
        InputError
            A file cannot be read.
        """
        mapping = self.scene.to_mapping(full=True)
        faults: list[Fault] = []
        for pointer, name in self.scene.file_references():
            if name.startswith("asset:"):
                continue
            try:
                data = self.files.read(name, pointer)
            except InputError as error:
                faults += error.faults
                continue
            digest = hashlib.sha256(data).hexdigest()
            write_atomically(assets / digest, data)
            *above, key = pointer[1:].split("/")
            holder = mapping
            for step in above:
                holder = holder[step]
            holder[key] = f"asset:{digest}"
        if faults:
            raise self.told(InputError(faults))
        return mapping

    def told(self, error: InputError) -> InputError:
        """Return an error about the scene as one that names the file first."""
        return InputError(
            Fault(f"{self.name}: {f.pointer}" if f.pointer else self.name, f.message) for f in error.faults
        )
