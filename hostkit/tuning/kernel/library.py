"""The compiled kernel: built once for this machine with its own C compiler, then kept."""

import contextlib
import ctypes
import functools
import hashlib
import os
import platform
import shutil
import subprocess
import tempfile
from pathlib import Path

SOURCES = tuple(Path(__file__).with_name(name) for name in ("kernel.c", "lanes.h"))
FLAGS = ("-O3", "-std=gnu11", "-fPIC", "-shared", "-fno-math-errno")
COMPILERS = ("cc", "gcc", "clang")
BUILD_TIMEOUT_S = 120
CHOICE = "HOSTKIT_KERNEL"
"""Environment variable: ``numpy`` keeps the compiled kernel from being used."""


@functools.lru_cache(maxsize=8)
def library(sources: tuple[Path, ...] = SOURCES) -> ctypes.CDLL | None:
    """Return a compiled kernel, built if need be; None where there is no C compiler.

    Parameters
    ----------
    sources
        What is compiled, and then the files that it includes.

    Notes
    -----
    It is built for the processor it is built on. So it is kept under a name that holds the
    processor's features: a home folder may be shared by different machines.
    """
    compiler = next((found for name in COMPILERS if (found := shutil.which(name))), None)
    if os.environ.get(CHOICE) == "numpy" or compiler is None:
        return None
    path = cache_folder() / f"kernel-{_fingerprint(compiler, sources)}.so"
    with contextlib.suppress(OSError):
        return ctypes.CDLL(str(path))
    try:
        _build(compiler, sources[0], path)
        return ctypes.CDLL(str(path))
    except (OSError, subprocess.SubprocessError):
        return _build_in_private(compiler, sources[0])


def cache_folder() -> Path:
    """Return where compiled kernels are kept."""
    root = os.environ.get("XDG_CACHE_HOME")
    return (Path(root) if root else Path.home() / ".cache") / "hostkit"


def _build(compiler: str, source: Path, path: Path) -> None:
    """Compile aside, then rename, so that two processes may build at once."""
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(prefix=".kernel-", suffix=".so", dir=path.parent)
    os.close(handle)
    aside = Path(name)
    try:
        _compile(compiler, source, aside)
        aside.replace(path)
    finally:
        aside.unlink(missing_ok=True)


def _build_in_private(compiler: str, source: Path) -> ctypes.CDLL | None:
    """Build for this process alone where nothing can be kept; None if that fails as well."""
    try:
        with tempfile.TemporaryDirectory(prefix="hostkit-") as folder:
            path = Path(folder) / "kernel.so"
            _compile(compiler, source, path)
            return ctypes.CDLL(str(path))
    except (OSError, subprocess.SubprocessError):
        return None


def _compile(compiler: str, source: Path, path: Path) -> None:
    subprocess.run(
        [compiler, *FLAGS, *_native(), "-o", str(path), str(source), "-lm"],
        check=True,
        capture_output=True,
        timeout=BUILD_TIMEOUT_S,
    )


def _native() -> tuple[str, ...]:
    """Ask for the processor's own instructions where its features can be told apart."""
    return ("-march=native",) if _processor() else ()


def _fingerprint(compiler: str, sources: tuple[Path, ...]) -> str:
    digest = hashlib.sha256()
    for source in sources:
        digest.update(source.read_bytes())
    about = (compiler, *FLAGS, *_native(), platform.system(), platform.machine(), _processor())
    digest.update("\0".join(about).encode())
    return digest.hexdigest()[:16]


def _processor() -> str:
    """Return the features of the processor, or an empty text where they are not known."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        return ""
    features = [line for line in lines if line.startswith(("flags", "Features", "model name"))]
    return "\n".join(sorted(set(features)))
