"""Times of the demonstration `rotating-calcite`: a draft frame, and a sequence, with the share of time per stage.

Run: ``python -m benchmarks.rotating_calcite [--frames 36] [--size 512] [--workers 2]``. The sequence is timed as a user
meets it, as a command; the draft frame is that of a warm process.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

from crystal_core.sequence import assemble, parse_request, render_tile, tile_grid

NAME = "rotating-calcite"


def draft_frame(side: int, repeats: int) -> None:
    """Print the time of one warm draft frame in this process, on one core."""
    request = parse_request({"demonstration": NAME, "size": [side, side], "quality": "draft", "frames": repeats + 1})
    times = []
    for index in range(repeats + 1):
        started = time.perf_counter()
        frame = assemble(request, [render_tile(request, index, tile) for tile in range(len(tile_grid(request)))])
        times.append(time.perf_counter() - started)
    warm = sorted(times[1:])
    print(
        f"draft {side} x {side}, one core: first {times[0]:.2f} s, then median {warm[len(warm) // 2]:.2f} s "
        f"(error estimate {frame.error_estimate:.4f})"
    )


def stages(side: int) -> None:
    """Print the share of time per stage of one standard frame, on one core."""
    request = parse_request({"demonstration": NAME, "size": [side, side], "frames": 12})
    shares: Counter[str] = Counter()
    render_tile(request, 0, 0)
    events, started = 0, time.perf_counter()
    slowest = 0.0
    for tile in range(len(tile_grid(request))):
        result = render_tile(request, 1, tile)
        shares.update(result.stages)
        events += result.events
        slowest = max(slowest, result.seconds)
    seconds = time.perf_counter() - started
    print(
        f"standard {side} x {side}, one core: {seconds:.2f} s, {events / 1e6:.1f} M face events, "
        f"slowest tile {slowest:.2f} s"
    )
    for stage, spent in shares.most_common():
        print(f"  {stage:12s} {100 * spent / seconds:5.1f} %")
    print(f"  face events per second of their stage: {events / shares['interfaces'] / 1e6:.2f} M")


def sequence(frames: int, side: int, workers: int) -> float:
    """Print and return the time of the whole command, files and animation included."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "out"
        command = [str(Path(sys.executable).parent / "isogyre"), "render", NAME, "--frames", str(frames)]
        command += ["--size", f"{side}x{side}", "--workers", str(workers), "--out", str(out)]
        started = time.perf_counter()
        subprocess.run(command, check=True)
        seconds = time.perf_counter() - started
        told = json.loads((out / "manifest.json").read_text())
    print(
        f"standard {side} x {side}, {frames} frames, {workers} workers: {seconds:.1f} s "
        f"(worst error estimate {told['error_estimate']:.4f})"
    )
    return seconds


def main() -> None:
    """Run all of it."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--frames", type=int, default=36)
    parser.add_argument("--size", type=int, default=512)
    parser.add_argument("--workers", type=int, default=os.cpu_count() or 1)
    wanted = parser.parse_args()
    draft_frame(256, 5)
    stages(wanted.size)
    several = sequence(wanted.frames, wanted.size, wanted.workers)
    if wanted.workers > 1:
        fewer = max(1, wanted.frames // 4)
        one = sequence(fewer, wanted.size, 1) / fewer
        print(f"one process takes {one / (several / wanted.frames):.2f} times as long a frame")


if __name__ == "__main__":
    main()
