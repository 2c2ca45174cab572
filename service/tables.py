"""The ledger's tables.

A *job* is what one caller asked for; a *run* is the work behind it, shared by all jobs of one request digest. A run
consists of *units* (one tile of one frame) and yields *frames* and *products* (named artifacts); its *events* are what
the event streams replay. Times are seconds since 1970, UTC.
"""

from __future__ import annotations

from sqlalchemy import Column, Double, ForeignKey, Index, Integer, MetaData, PrimaryKeyConstraint, String, Table, Text

__all__ = ["LIVE", "SCHEMA_VERSION", "artifact", "event", "frame", "job", "metadata", "product", "run", "unit"]

SCHEMA_VERSION = 1
"""Stands in SQLite's ``user_version``; a ledger of another version is refused, never guessed at."""

LIVE = ("accepted", "running")
"""States of a run that is still to be worked on; the others are successful, failed and dismissed."""

metadata = MetaData()

run = Table(
    "run",
    metadata,
    Column("id", String(26), primary_key=True),
    Column("digest", String(64), nullable=False),
    Column("request", Text, nullable=False),  # canonical, JSON
    Column("status", String(16), nullable=False),
    Column("problem", Text),  # RFC 9457 object, JSON; why it failed
    Column("frames", Integer, nullable=False),
    Column("tiles", Integer, nullable=False),  # of the whole run
    Column("frames_done", Integer, nullable=False, default=0),
    Column("tiles_done", Integer, nullable=False, default=0),
    Column("last_event", Integer, nullable=False, default=0),
    Column("created_at", Double, nullable=False),
    Column("started_at", Double),
    Column("ended_at", Double),
    Index("run_by_digest", "digest"),
    Index("run_by_status", "status"),
)

job = Table(
    "job",
    metadata,
    Column("id", String(26), primary_key=True),
    Column("run_id", ForeignKey("run.id"), nullable=False),
    Column("created_at", Double, nullable=False),
    Column("dismissed_at", Double),
    Index("job_by_run", "run_id"),
)

unit = Table(
    "unit",
    metadata,
    Column("run_id", ForeignKey("run.id"), nullable=False),
    Column("frame", Integer, nullable=False),
    Column("tile", Integer, nullable=False),
    Column("state", String(16), nullable=False),  # successful or failed; a unit that has not ended has no row
    Column("sha256", String(64)),  # of the file that keeps its result until its frame is finished
    Column("seconds", Double),
    Column("ended_at", Double, nullable=False),
    PrimaryKeyConstraint("run_id", "frame", "tile"),
)

frame = Table(
    "frame",
    metadata,
    Column("run_id", ForeignKey("run.id"), nullable=False),
    Column("index", Integer, nullable=False),
    Column("angle_deg", Double, nullable=False),
    Column("error_estimate", Double, nullable=False),
    Column("seconds", Double, nullable=False),
    Column("clipped_fraction", Double, nullable=False),
    PrimaryKeyConstraint("run_id", "index"),
)

artifact = Table(
    "artifact",
    metadata,
    Column("sha256", String(64), primary_key=True),
    Column("media_type", String(64), nullable=False),
    Column("size", Integer, nullable=False),
    Column("created_at", Double, nullable=False),
)

product = Table(
    "product",
    metadata,
    Column("run_id", ForeignKey("run.id"), nullable=False),
    Column("name", String(64), nullable=False),
    Column("sha256", ForeignKey("artifact.sha256"), nullable=False),
    PrimaryKeyConstraint("run_id", "name"),
)

event = Table(
    "event",
    metadata,
    Column("run_id", ForeignKey("run.id"), nullable=False),
    Column("number", Integer, nullable=False),  # 1, 2, … within the run: the id of the server-sent event
    Column("kind", String(16), nullable=False),
    Column("data", Text, nullable=False),  # JSON
    Column("at", Double, nullable=False),
    PrimaryKeyConstraint("run_id", "number"),
)
