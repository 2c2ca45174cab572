"""The Dockerfile, as far as it can be judged without an engine."""

from __future__ import annotations

import json
import re
import tomllib

import pytest

from tests.packaging.sources import ROOT

Instruction = tuple[str, str]


@pytest.fixture(scope="module")
def stages() -> list[list[Instruction]]:
    """Give the instructions (name, rest) of each stage, continued lines joined."""
    text = (ROOT / "Dockerfile").read_text(encoding="utf-8").replace("\\\n", " ")
    lines = [line.strip() for line in text.splitlines() if line.strip() and not line.startswith("#")]
    found: list[list[Instruction]] = []
    for line in lines:
        name, _, rest = line.partition(" ")
        if name == "FROM":
            found.append([])
        found[-1].append((name, rest.strip()))
    return found


def of(stage: list[Instruction], name: str) -> list[str]:
    return [rest for instruction, rest in stage if instruction == name]


def environment(stage: list[Instruction]) -> dict[str, str]:
    return dict(pair.split("=", 1) for line in of(stage, "ENV") for pair in line.split())


def test_it_runs_as_somebody_without_rights(stages: list[list[Instruction]]) -> None:
    names = [name for name, _ in stages[-1]]
    (user,) = of(stages[-1], "USER")
    assert re.fullmatch(r"[1-9]\d*:[1-9]\d*", user)  # numbers: orchestrators check them before they start the image
    assert f"useradd --uid {user.split(':')[0]} " in of(stages[-1], "RUN")[0]
    assert names.index("USER") > max(i for i, name in enumerate(names) if name == "RUN")


def test_only_what_the_locks_name_is_installed(stages: list[list[Instruction]]) -> None:
    installs = [
        step for stage in stages for run in of(stage, "RUN") for step in run.split("&&") if "pip install" in step
    ]
    locks = {}
    for step in installs:
        if "--no-deps --no-index" in step:
            assert step.split()[-1] == "dist/isogyre-*.whl"
            continue
        assert "--require-hashes" in step
        (lock,) = re.findall(r"-r (\S+)", step)
        locks[lock] = step.split()[0]
    assert set(locks) == {"requirements/runtime.txt", "requirements/build.txt"}
    assert len(set(locks.values())) == 2, "the tools of the build do not belong into the image"
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    for lock in locks:
        assert (ROOT / lock).is_file()
        assert f"-r {lock}" in makefile


def test_the_build_gets_all_its_files(stages: list[list[Instruction]]) -> None:
    copied = {word for line in of(stages[0], "COPY") for word in line.split()[:-1]}
    with (ROOT / "pyproject.toml").open("rb") as file:
        project = tomllib.load(file)
    target = project["tool"]["hatch"]["build"]["targets"]["wheel"]
    needed = {"pyproject.toml", project["project"]["readme"], *project["project"]["license-files"]}
    needed |= {*target["packages"], *target["force-include"]}
    assert needed <= copied
    assert all((ROOT / name).exists() for name in copied)
    allowed = (ROOT / ".dockerignore").read_text(encoding="utf-8").splitlines()
    assert "*" in allowed
    assert copied == {line[1:] for line in allowed if line.startswith("!")}


def test_it_keeps_its_data_in_a_volume_of_its_own(stages: list[list[Instruction]]) -> None:
    data = environment(stages[-1])["ISOGYRE_DATA_DIR"]
    assert of(stages[-1], "VOLUME") == [data]
    # The folder is the user's before it becomes a volume: an unnamed volume takes its owner over.
    assert f"--home-dir {data} --create-home" in of(stages[-1], "RUN")[0]


def test_it_serves_and_is_asked_whether_it_is_ready(stages: list[list[Instruction]]) -> None:
    command = json.loads(of(stages[-1], "CMD")[0])
    assert command[:4] == ["isogyre", "serve", "--host", "0.0.0.0"]
    port = command[command.index("--port") + 1]
    assert of(stages[-1], "EXPOSE") == [port]
    (check,) = of(stages[-1], "HEALTHCHECK")
    program = json.loads(check[check.index("CMD ") + 4 :])
    assert program[:2] == ["python", "-c"]
    compile(program[2], "healthcheck", "exec")
    assert f"http://127.0.0.1:{port}/readyz" in program[2]
