"""Where gaitctl and gaitd are, and how they are run."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from pathlib import Path
from typing import Any, Dict, Iterable, List, Mapping, Optional, Union

from .errors import ProgramError
from .plain import plain

__all__ = ["find_program", "write_yaml"]


def find_program(name: str) -> str:
    """The path of ``gaitctl`` or ``gaitd``.

    Looked for in the folder that ``$GAITD_BIN`` names, then beside this package (a build tree or an installation),
    then on the PATH. Raises :class:`ProgramError`.
    """
    given = os.environ.get("GAITD_BIN")
    if given:
        candidates: Iterable[Path] = [Path(given)]
    else:
        here = Path(__file__).parent
        # <build>/python/gaitd, or <prefix>/lib/python3/dist-packages/gaitd
        candidates = [folder / "bin" for folder in (*here.parents[1:2], *here.parents[3:4])]
    for folder in candidates:
        if os.access(folder / name, os.X_OK):
            return str(folder / name)
    found = None if given else shutil.which(name)
    if found is None:
        where = f"$GAITD_BIN ({given})" if given else "beside the package or on the PATH"
        raise ProgramError(f"no {name} {where}: install gaitd, or put build/release/bin on the PATH")
    return found


def assignments(settings: Optional[Mapping[str, Any]]) -> List[str]:
    """``--set KEY=VALUE`` for each; values in JSON, which is YAML."""
    arguments: List[str] = []
    if settings is not None and not isinstance(settings, Mapping):
        raise TypeError(f"set={settings!r}: expected a dict of keys and values, for example {{'seed': 2}}")
    for key, value in (settings or {}).items():
        text = value if isinstance(value, str) else json.dumps(plain(value), allow_nan=False)
        arguments += ["--set", f"{key}={text}"]
    return arguments


def write_yaml(path: Union[str, "os.PathLike[str]"], document: Mapping[str, Any]) -> None:
    """Writes a scenario or a campaign that is a dict to a file, in JSON, which is YAML; numpy's types are taken too."""
    Path(path).write_text(json.dumps(plain(document), indent=2, allow_nan=False) + "\n", encoding="utf-8")


def gaitctl_json(arguments: List[str], cwd: Optional[str] = None) -> Dict[str, Any]:
    """What ``gaitctl --json`` prints, whether what it judged passed or not. Raises ProgramError otherwise."""
    done = subprocess.run(
        [find_program("gaitctl"), "--json", *arguments],
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        cwd=cwd,
        check=False,
    )
    try:
        result = json.loads(done.stdout)
    except ValueError:
        result = None
    if not isinstance(result, dict):
        raise ProgramError(done.stderr.strip() or f"gaitctl ended with exit code {done.returncode}", done.returncode)
    if "error" in result:
        raise ProgramError(result["error"]["message"], done.returncode)
    if done.returncode not in (0, 1, 4):
        raise ProgramError(done.stderr.strip() or "interrupted", done.returncode)
    return result
