"""Builds the wheel of gaitd by the CMake of the source tree (PEP 517).

$GAITD_BUILD names a build tree to use; by default it is build/python, which stays for the next time.
"""

import base64
import hashlib
import os
import re
import subprocess
import sys
import sysconfig
import tempfile
import zipfile
from pathlib import Path

SOURCE = Path(__file__).resolve().parent.parent


def _version():
    found = re.search(r"project\(gaitd VERSION ([0-9.]+)", (SOURCE / "CMakeLists.txt").read_text(encoding="utf-8"))
    return found.group(1)


def _build(prefix):
    cmake = os.environ.get("CMAKE", "cmake")
    build = Path(os.environ.get("GAITD_BUILD") or SOURCE / "build/python")
    if not os.environ.get("GAITD_BUILD"):
        subprocess.check_call(
            [cmake, "-S", SOURCE, "-B", build, "-DCMAKE_BUILD_TYPE=Release", "-DGAITD_BUILD_TESTS=OFF",
             "-DGAITD_BUILD_BENCHMARKS=OFF", f"-DPython3_EXECUTABLE={sys.executable}"]
        )  # fmt: skip
    subprocess.check_call([cmake, "--build", build, "--target", "gaitd_python", "--parallel", str(os.cpu_count())])
    subprocess.check_call([cmake, "--install", build, "--component", "python", "--prefix", prefix])
    return Path(prefix) / "lib/python3/dist-packages/gaitd"


def _record(name, content):
    digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
    return f"{name},sha256={digest},{len(content)}\n"


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    version = _version()
    interpreter = f"cp{sys.version_info.major}{sys.version_info.minor}"
    platform = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    tag = f"{interpreter}-{interpreter}-{platform}"
    info = f"gaitd-{version}.dist-info"
    files = {
        f"{info}/METADATA": (
            f"Metadata-Version: 2.1\nName: gaitd\nVersion: {version}\nRequires-Python: >=3.9\nRequires-Dist: numpy\n"
            "Provides-Extra: frames\nRequires-Dist: pandas; extra == 'frames'\n"
            "Summary: gaitd from Python: robots, scenarios, campaigns and logs\nLicense: Apache-2.0\n"
        ).encode(),
        f"{info}/WHEEL": (
            f"Wheel-Version: 1.0\nGenerator: gaitd\nRoot-Is-Purelib: false\nTag: {tag}\n"
        ).encode(),
    }
    with tempfile.TemporaryDirectory() as prefix:
        for file in sorted(_build(prefix).iterdir()):
            files[f"gaitd/{file.name}"] = file.read_bytes()
    record = "".join(_record(name, content) for name, content in files.items())
    files[f"{info}/RECORD"] = (record + f"{info}/RECORD,,\n").encode()
    wheel = f"gaitd-{version}-{tag}.whl"
    with zipfile.ZipFile(Path(wheel_directory) / wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(name, content)
    return wheel


def build_sdist(sdist_directory, config_settings=None):
    raise RuntimeError("gaitd is built in its source tree: pip install ./python")
