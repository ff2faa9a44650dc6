"""Writing a file so that a reader never sees half of it."""

import os
import secrets
from pathlib import Path

from hostkit.errors import HostkitError


def write_aside(path: Path, content: bytes | str) -> None:
    """Write a file under a temporary name beside its place, then rename it.

    Parameters
    ----------
    path
        Where the file goes. Its folder must exist; a file of that name is replaced. What is no
        file, such as ``/dev/null`` or a pipe, is written to and stays what it is.
    content
        The bytes, or text that is written as UTF-8 with its line ends as they are.

    Raises
    ------
    HostkitError
        If the folder is missing or not writable, or the disk is full. The old file, if there was
        one, is then untouched and no temporary file is left.
    """
    payload = content.encode("utf-8") if isinstance(content, str) else content
    target = path.resolve()
    if target.exists() and not target.is_file():
        _write_through(path, payload)
        return
    try:
        _replace(target, payload)
    except OSError as error:
        raise _refusal(path, error) from error


def _write_through(path: Path, payload: bytes) -> None:
    """Write to a device or a pipe, which must not be replaced by a file."""
    try:
        with path.open("wb") as stream:
            stream.write(payload)
    except OSError as error:
        raise _refusal(path, error) from error


def _replace(target: Path, payload: bytes) -> None:
    """Write and rename; the name is known before the file exists, so that none is ever left."""
    temporary = target.with_name(f".{target.name[:100]}.{secrets.token_hex(8)}.part")
    try:
        with open(temporary, "xb", opener=_for_the_owner) as stream:
            stream.write(payload)
            stream.flush()
            os.fsync(stream.fileno())
        temporary.chmod(_mode_of(target))
        temporary.replace(target)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


def _for_the_owner(path: str, flags: int) -> int:
    return os.open(path, flags, 0o600)


def _mode_of(target: Path) -> int:
    """Return the permissions a plainly written file would have."""
    if target.exists():
        return target.stat().st_mode & 0o777
    mask = os.umask(0)
    os.umask(mask)
    return 0o666 & ~mask


def _refusal(path: Path, error: OSError) -> HostkitError:
    reason = error.strerror or str(error)
    return HostkitError(f"{path} cannot be written: {reason}")
