"""Check that the lock files pin what pyproject.toml asks for, on every machine; needs no network.

Prints one line a problem and exits 1, or one line of praise and exits 0.
"""

import re
import sys
import tomllib
from pathlib import Path

from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

ROOT = Path(__file__).resolve().parent.parent
PIN = re.compile(r"^([A-Za-z0-9][A-Za-z0-9._-]*)==([A-Za-z0-9.!]+)$")
UNWANTED = ("nvidia-", "cuda-", "triton")  # several GB that only a GPU build of torch needs


def read_pins(path: Path) -> tuple[dict[str, str], list[str]]:
    """Return {canonical name: version} of a lock file and what is wrong with its lines."""
    pins: dict[str, str] = {}
    problems: list[str] = []
    for number, line in enumerate(path.read_text().splitlines(), start=1):
        if not line or line.startswith("#"):
            continue
        match = PIN.match(line)
        where = f"{path.relative_to(ROOT)}:{number}"
        if not match:
            problems.append(f"{where}: not 'name==version': {line!r}")
            continue
        name = canonicalize_name(match[1])
        if name in pins:
            problems.append(f"{where}: {name} is pinned twice")
        if name.startswith(UNWANTED):
            problems.append(f"{where}: {name} belongs to a GPU build of torch")
        pins[name] = match[2]
    return pins, problems


def find_problems() -> list[str]:
    """Compare both lock files with pyproject.toml and with each other."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    run, problems = read_pins(ROOT / "requirements" / "run.lock")
    dev, dev_problems = read_pins(ROOT / "requirements" / "dev.lock")
    problems += dev_problems
    for file, pins, wanted in (
        ("run.lock", run, project["dependencies"]),
        ("dev.lock", dev, project["dependencies"] + project["optional-dependencies"]["dev"]),
    ):
        for text in wanted:
            requirement = Requirement(text)
            version = pins.get(canonicalize_name(requirement.name))
            if version is None:
                problems.append(f"{file}: {requirement.name} is missing; run scripts/lock")
            elif not requirement.specifier.contains(version, prereleases=True):
                problems.append(f"{file}: {requirement.name}=={version} is not {requirement.specifier}")
    for name, version in run.items():
        if dev.get(name) != version:
            problems.append(f"dev.lock: {name} is {dev.get(name)}, but {version} in run.lock")
    return problems


if __name__ == "__main__":
    found = find_problems()
    print("\n".join(found) or "lock files: complete")
    sys.exit(1 if found else 0)
