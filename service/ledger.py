"""The ledger: what was asked for, what has been done, what came of it. The only truth about a job.

Every method is one transaction; what it has reported is on the disk (SQLite, WAL, ``synchronous=FULL``).
"""

from __future__ import annotations

import json
import time
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from sqlalchemy import Connection, create_engine, delete, event, func, insert, select, update
from sqlalchemy.exc import DatabaseError
from ulid import ULID

from crystal_core.errors import InputError
from service.records import Event, FrameRow, Job, Problem, Product, Run, UnitRow, as_run, frame_name
from service.tables import LIVE, SCHEMA_VERSION, metadata
from service.tables import artifact as artifact_table
from service.tables import event as event_table
from service.tables import frame as frame_table
from service.tables import job as job_table
from service.tables import product as product_table
from service.tables import run as run_table
from service.tables import unit as unit_table

__all__ = ["Ledger"]


class Ledger:
    """The ledger in one SQLite file.

    Parameters
    ----------
    path : Path
        The file; made if missing, its folder must exist.

    Raises
    ------
    InputError
        If the file is no ledger of this version or cannot be opened.
    """

    def __init__(self, path: Path) -> None:
        # Threads of the HTTP server read at the same time; a reader that waits for a connection waits for no lock.
        self._engine = create_engine(f"sqlite:///{path}", pool_size=8, max_overflow=64)
        event.listen(self._engine, "connect", _on_connect)
        event.listen(self._engine, "begin", _on_begin)
        self._writer = self._engine.execution_options(writes=True)
        try:
            with self._writer.begin() as connection:
                version = connection.exec_driver_sql("PRAGMA user_version").scalar_one()
                if version == 0:
                    metadata.create_all(connection)
                    connection.exec_driver_sql(f"PRAGMA user_version = {SCHEMA_VERSION}")
        except DatabaseError as error:
            self.close()
            raise InputError.at("ISOGYRE_DATA_DIR", f"{path} cannot be used as a ledger: {error.orig}") from error
        if version not in (0, SCHEMA_VERSION):
            self.close()
            raise InputError.at(
                "ISOGYRE_DATA_DIR", f"{path} has version {version}; this program knows version {SCHEMA_VERSION}"
            )

    def close(self) -> None:
        """Close all connections."""
        self._engine.dispose()

    def check(self) -> None:
        """Raise a DatabaseError if the ledger cannot be read."""
        with self._engine.connect() as connection:
            connection.execute(select(run_table.c.id).limit(1)).all()

    # jobs

    def submit(self, request: Mapping[str, Any], digest: str, *, frames: int, tiles: int) -> tuple[Job, bool]:
        """Accept a job.

        Parameters
        ----------
        request : mapping
            The canonical request.
        digest : str
            Its request digest. A live or successful run of the same digest is shared, otherwise one begins.
        frames, tiles : int
            What the whole run consists of.

        Returns
        -------
        Job
            The new job.
        bool
            Whether its run is new.
        """
        now = time.time()
        with self._writer.begin() as connection:
            run_id = connection.execute(
                select(run_table.c.id)
                .where(run_table.c.digest == digest, run_table.c.status.in_((*LIVE, "successful")))
                .order_by(run_table.c.created_at.desc())
                .limit(1)
            ).scalar_one_or_none()
            new = run_id is None
            if run_id is None:
                run_id = str(ULID())
                connection.execute(
                    insert(run_table).values(
                        id=run_id,
                        digest=digest,
                        request=json.dumps(request, sort_keys=True),
                        status="accepted",
                        frames=frames,
                        tiles=tiles,
                        created_at=now,
                    )
                )
                _add_event(connection, run_id, "status", {"status": "accepted"})
            job_id = str(ULID())
            connection.execute(insert(job_table).values(id=job_id, run_id=run_id, created_at=now))
            job = _job(connection, job_id)
        assert job is not None
        return job, new

    def job(self, job_id: str) -> Job | None:
        """Return a job, or None if there is none of this id."""
        with self._engine.connect() as connection:
            return _job(connection, job_id)

    def dismiss(self, job_id: str) -> Run | None:
        """Detach a job from its run, and end the run if it was live and this was its last job.

        Returns
        -------
        Run or None
            The run, if it has ended by this.
        """
        with self._writer.begin() as connection:
            job = _job(connection, job_id)
            if job is None or job.dismissed_at is not None:
                return None
            connection.execute(update(job_table).where(job_table.c.id == job_id).values(dismissed_at=time.time()))
            left = connection.execute(
                select(func.count())
                .select_from(job_table)
                .where(job_table.c.run_id == job.run.id, job_table.c.dismissed_at.is_(None))
            ).scalar_one()
            if left or not _end(connection, job.run.id, "dismissed", None):
                return None
            return _run(connection, job.run.id)

    # runs

    def live_runs(self) -> list[Run]:
        """Return the runs that are still to be worked on, oldest first."""
        with self._engine.connect() as connection:
            rows = connection.execute(
                select(run_table).where(run_table.c.status.in_(LIVE)).order_by(run_table.c.created_at, run_table.c.id)
            )
            return [as_run(row) for row in rows]

    def start(self, run_id: str) -> bool:
        """Note that work on an accepted run has begun; False if it was not accepted (any more)."""
        with self._writer.begin() as connection:
            done = connection.execute(
                update(run_table)
                .where(run_table.c.id == run_id, run_table.c.status == "accepted")
                .values(status="running", started_at=time.time())
            )
            if done.rowcount:
                _add_event(connection, run_id, "status", {"status": "running"})
            return bool(done.rowcount)

    def finish_unit(self, run_id: str, frame: int, tile: int, *, sha256: str, seconds: float) -> bool:
        """Note a unit's result; False if the run is no longer live."""
        with self._writer.begin() as connection:
            if not _count(connection, run_id, tiles_done=run_table.c.tiles_done + 1):
                return False
            connection.execute(
                insert(unit_table).values(
                    run_id=run_id,
                    frame=frame,
                    tile=tile,
                    state="successful",
                    sha256=sha256,
                    seconds=seconds,
                    ended_at=time.time(),
                )
            )
            return True

    def lose_units(self, run_id: str, units: Iterable[tuple[int, int]]) -> None:
        """Forget results of units (frame, tile) whose files are gone or damaged: they are to be done again."""
        with self._writer.begin() as connection:
            for frame, tile in units:
                gone = connection.execute(
                    delete(unit_table).where(
                        unit_table.c.run_id == run_id, unit_table.c.frame == frame, unit_table.c.tile == tile
                    )
                )
                _count(connection, run_id, tiles_done=run_table.c.tiles_done - gone.rowcount)

    def finish_frame(self, run_id: str, frame: FrameRow, products: Iterable[Product]) -> bool:
        """Note a finished frame, its artifacts and its event; False if the run is no longer live."""
        with self._writer.begin() as connection:
            if not _count(connection, run_id, frames_done=run_table.c.frames_done + 1):
                return False
            connection.execute(
                insert(frame_table).values(
                    run_id=run_id,
                    index=frame.index,
                    angle_deg=frame.angle_deg,
                    error_estimate=frame.error_estimate,
                    seconds=frame.seconds,
                    clipped_fraction=frame.clipped_fraction,
                )
            )
            _add_products(connection, run_id, products)
            _add_event(connection, run_id, "frame", {"index": frame.index})
            return True

    def succeed(self, run_id: str, products: Iterable[Product]) -> bool:
        """End a live run with its last artifacts; False if it is no longer live."""
        with self._writer.begin() as connection:
            if not _end(connection, run_id, "successful", None):
                return False
            _add_products(connection, run_id, products)
            return True

    def fail(self, run_id: str, problem: Problem, unit: tuple[int, int] | None = None) -> bool:
        """End a live run with the reason and the unit (frame, tile) that failed; False if it is no longer live."""
        with self._writer.begin() as connection:
            if not _end(connection, run_id, "failed", problem):
                return False
            if unit is not None:
                connection.execute(
                    insert(unit_table).values(
                        run_id=run_id, frame=unit[0], tile=unit[1], state="failed", ended_at=time.time()
                    )
                )
            return True

    def restart(self, run_id: str, digest: str, tiles: int) -> None:
        """Begin a live run anew under another digest: the code or the data have changed since it was accepted."""
        with self._writer.begin() as connection:
            for table in (unit_table, frame_table, product_table):
                connection.execute(delete(table).where(table.c.run_id == run_id))
            connection.execute(delete(event_table).where(event_table.c.run_id == run_id, event_table.c.kind == "frame"))
            connection.execute(
                update(run_table)
                .where(run_table.c.id == run_id)
                .values(digest=digest, tiles=tiles, frames_done=0, tiles_done=0)
            )

    # what a run has yielded

    def units(self, run_id: str) -> list[UnitRow]:
        """Return the units of a run that have ended with a result."""
        with self._engine.connect() as connection:
            rows = connection.execute(
                select(unit_table.c.frame, unit_table.c.tile, unit_table.c.sha256).where(
                    unit_table.c.run_id == run_id, unit_table.c.state == "successful"
                )
            )
            return [UnitRow(*row) for row in rows]

    def frames(self, run_id: str) -> list[FrameRow]:
        """Return the finished frames of a run by index."""
        with self._engine.connect() as connection:
            rows = connection.execute(
                select(frame_table).where(frame_table.c.run_id == run_id).order_by(frame_table.c.index)
            ).all()
            named = connection.execute(
                select(product_table.c.name, product_table.c.sha256).where(product_table.c.run_id == run_id)
            ).all()
        digests: dict[str, str] = {row.name: row.sha256 for row in named}
        frames = [dict(row._mapping) for row in rows]
        return [
            FrameRow(
                index=row["index"],
                angle_deg=row["angle_deg"],
                error_estimate=row["error_estimate"],
                seconds=row["seconds"],
                sha256=digests[frame_name(row["index"], "png")],
                clipped_fraction=row["clipped_fraction"],
            )
            for row in frames
        ]

    def product(self, run_id: str, name: str) -> Product | None:
        """Return a named artifact of a run, or None if it is not there (yet)."""
        with self._engine.connect() as connection:
            row = connection.execute(
                select(
                    product_table.c.name, artifact_table.c.sha256, artifact_table.c.media_type, artifact_table.c.size
                )
                .join_from(product_table, artifact_table)
                .where(product_table.c.run_id == run_id, product_table.c.name == name)
            ).one_or_none()
            return None if row is None else Product(*row)

    def events(self, run_id: str, after: int) -> list[Event]:
        """Return the events of a run whose number is above ``after``, in order."""
        with self._engine.connect() as connection:
            rows = connection.execute(
                select(event_table.c.number, event_table.c.kind, event_table.c.data)
                .where(event_table.c.run_id == run_id, event_table.c.number > after)
                .order_by(event_table.c.number)
            )
            return [Event(number, kind, json.loads(data)) for number, kind, data in rows]


def _on_connect(raw: Any, record: object) -> None:  # noqa: ARG001
    raw.isolation_level = None  # transactions begin where we say, in `_on_begin`
    for pragma in ("busy_timeout=10000", "journal_mode=WAL", "synchronous=FULL", "foreign_keys=ON"):
        raw.execute(f"PRAGMA {pragma}")


def _on_begin(connection: Connection) -> None:
    # A transaction that will write takes the lock at once: turning a read into a write would fail, not wait.
    writes = connection.get_execution_options().get("writes", False)
    connection.exec_driver_sql("BEGIN IMMEDIATE" if writes else "BEGIN")


def _run(connection: Connection, run_id: str) -> Run:
    return as_run(connection.execute(select(run_table).where(run_table.c.id == run_id)).one())


def _job(connection: Connection, job_id: str) -> Job | None:
    row = connection.execute(select(job_table).where(job_table.c.id == job_id)).one_or_none()
    return None if row is None else Job(row.id, row.created_at, row.dismissed_at, _run(connection, row.run_id))


def _count(connection: Connection, run_id: str, **counts: Any) -> bool:
    """Change counters of a live run; False if it is no longer live."""
    done = connection.execute(
        update(run_table).where(run_table.c.id == run_id, run_table.c.status.in_(LIVE)).values(**counts)
    )
    return bool(done.rowcount)


def _end(connection: Connection, run_id: str, status: str, problem: Problem | None) -> bool:
    text = None if problem is None else json.dumps(problem)
    if not _count(connection, run_id, status=status, problem=text, ended_at=time.time()):
        return False
    _add_event(connection, run_id, "status", {"status": status, "problem": problem})
    return True


def _add_event(connection: Connection, run_id: str, kind: str, data: Mapping[str, Any]) -> None:
    connection.execute(update(run_table).where(run_table.c.id == run_id).values(last_event=run_table.c.last_event + 1))
    number = connection.execute(select(run_table.c.last_event).where(run_table.c.id == run_id)).scalar_one()
    connection.execute(
        insert(event_table).values(run_id=run_id, number=number, kind=kind, data=json.dumps(data), at=time.time())
    )


def _add_products(connection: Connection, run_id: str, products: Iterable[Product]) -> None:
    for item in products:
        known = connection.execute(
            select(artifact_table.c.sha256).where(artifact_table.c.sha256 == item.sha256)
        ).scalar_one_or_none()
        if known is None:
            connection.execute(
                insert(artifact_table).values(
                    sha256=item.sha256, media_type=item.media_type, size=item.size, created_at=time.time()
                )
            )
        connection.execute(insert(product_table).values(run_id=run_id, name=item.name, sha256=item.sha256))
