"""What can be set from the environment (``ISOGYRE_*``)."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, ValidationError, field_validator
from pydantic_settings import BaseSettings, SettingsConfigDict

from crystal_core.errors import Fault, InputError
from minerals_db.library import OWN_FOLDER_VARIABLE, own_folder

__all__ = ["Settings", "load_settings"]

_PREFIX = "ISOGYRE_"


def _default_data_dir() -> Path:
    """Return the user's data directory after the XDG base directory specification."""
    base = os.environ.get("XDG_DATA_HOME", "")
    # A relative XDG_DATA_HOME is to be ignored, says the specification.
    root = Path(base) if base and Path(base).is_absolute() else Path.home() / ".local" / "share"
    return root / "isogyre"


def _default_workers() -> int:
    """Return the number of processors this process may use."""
    return len(os.sched_getaffinity(0))


class Settings(BaseSettings):
    """Settings of the service; each is an environment variable ``ISOGYRE_<NAME>``."""

    model_config = SettingsConfigDict(env_prefix=_PREFIX, frozen=True, extra="ignore")

    data_dir: Path = Field(default_factory=_default_data_dir, description="Ledger, artifacts and scratch files")
    workers: Annotated[int, Field(ge=1, le=256)] = Field(
        default_factory=_default_workers, description="Worker processes of one thread each"
    )
    worker_niceness: Annotated[int, Field(ge=0, le=19)] = Field(
        default=5, description="How far workers stand behind the service when processors are scarce"
    )
    max_body_bytes: Annotated[int, Field(ge=1024)] = Field(default=1_048_576, description="Largest request body")
    max_asset_bytes: Annotated[int, Field(ge=1024)] = Field(
        default=16_777_216, description="Largest file that is taken as an asset"
    )
    minerals_dir: Path | None = Field(
        default=None,
        description="Folder of the user's own minerals. The environment alone decides: every process of a render reads "
        "it there; it is checked with the settings",
    )
    log_level: Literal["debug", "info", "warning", "error"] = Field(
        default="info", description="Least level that is logged"
    )
    log_format: Literal["auto", "console", "json"] = Field(
        default="auto", description="auto: for people on a terminal, JSON lines elsewhere"
    )

    @field_validator("data_dir")
    @classmethod
    def _absolute(cls, path: Path) -> Path:
        # Worker processes and later working directories must mean the same folder.
        return path.expanduser().absolute()

    @field_validator("minerals_dir", mode="before")
    @classmethod
    def _is_the_environments_folder(cls, value: object) -> Path | None:
        folder = own_folder()  # what minerals_db reads, whatever it makes of the value
        if value not in (None, "", os.environ.get(OWN_FOLDER_VARIABLE), folder):
            raise ValueError(f"is set by the environment variable {OWN_FOLDER_VARIABLE} alone")
        if folder is not None and not folder.is_dir():
            raise ValueError(f"{folder} is not a folder" if folder.exists() else f"there is no folder {folder}")
        return folder


def load_settings() -> Settings:
    """Read the settings from the environment.

    Returns
    -------
    Settings

    Raises
    ------
    InputError
        Naming every variable whose value is unusable; the pointer is the variable's name.
    """
    try:
        return Settings()
    except ValidationError as error:
        raise InputError(
            Fault(
                f"{_PREFIX}{'_'.join(str(part) for part in fault['loc']).upper()}",
                fault["msg"].removeprefix("Value error, "),
            )
            for fault in error.errors()
        ) from None
