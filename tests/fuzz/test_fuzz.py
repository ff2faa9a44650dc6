"""The receive path and the driver under libFuzzer, with sanitizers, for a bounded time."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest
from boards import generated, require_or_skip
from designs import all_parameters

HERE = Path(__file__).parent
SECONDS = int(os.environ.get("HOSTKIT_FUZZ_S", "60"))
HARNESSES = ("fuzz_link", "fuzz_driver")
BOARD_FILES = ("hk_hal_", "hk_host_", "hk_virtual_")
SANITIZERS = ("-fsanitize=fuzzer,address,undefined", "-fno-sanitize-recover=all")
LIMITS = ("-max_len=4096", "-timeout=20", "-rss_limit_mb=1024", "-print_final_stats=1")


def built(folder: Path, name: str) -> Path:
    """Compile a harness over the application, with the board of the fuzzers below it."""
    sources = [
        path.name for path in sorted(folder.glob("hk_*.c")) if not path.name.startswith(BOARD_FILES)
    ]
    command = ["clang", "-g", "-O1", *SANITIZERS, "-isystem", "mavlink", "-o", name]
    done = subprocess.run(
        [*command, f"{name}.c", "fuzz_board.c", *sources],
        cwd=folder,
        capture_output=True,
        text=True,
        timeout=300,
        check=False,
    )
    if "libclang_rt.fuzzer" in done.stderr:
        pytest.skip("clang has no libFuzzer; on Debian it is in libclang-rt-14-dev")
    assert done.returncode == 0, done.stderr
    return folder / name


@pytest.fixture(scope="module")
def harness_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    require_or_skip("clang")
    folder = generated("host", tmp_path_factory.mktemp("fuzz"), all_parameters())
    for path in (*HERE.glob("*.c"), *HERE.glob("*.h")):
        shutil.copy(path, folder)
    return folder


@pytest.mark.timeout(SECONDS + 400)
def test_the_fuzzers_find_nothing(harness_folder: Path) -> None:
    """Both at once: one core each."""
    programs = [built(harness_folder, name) for name in HARNESSES]
    running = [
        subprocess.Popen(
            [str(program), f"-max_total_time={SECONDS}", "-seed=1", *LIMITS],
            cwd=harness_folder,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
        )
        for program in programs
    ]
    said = [child.communicate(timeout=SECONDS + 200)[1] for child in running]
    for child, text in zip(running, said, strict=True):
        assert child.returncode == 0, text[-4000:]
        assert "Done" in text
