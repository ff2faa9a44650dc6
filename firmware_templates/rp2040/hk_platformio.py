"""What platformio.ini cannot say: how to link, and the checksum of the second-stage loader."""

import subprocess
from pathlib import Path

from SCons.Script import DefaultEnvironment

CPU = ["-mcpu=cortex-m0plus", "-mthumb"]
POLYNOMIAL = 0x04C11DB7
LOADER_BYTES = 252


def checksum(loader: bytes) -> int:
    """Return the CRC-32 that the boot ROM takes: high bit first, begun with ones, not inverted."""
    crc = 0xFFFFFFFF
    for byte in loader.ljust(LOADER_BYTES, b"\0"):
        crc ^= byte << 24
        for _ in range(8):
            crc = (crc << 1 ^ (POLYNOMIAL if crc & 0x80000000 else 0)) & 0xFFFFFFFF
    return crc


def loader_checksum(environment) -> Path:
    """Assemble the loader and write assembly that holds its checksum; return that file."""
    folder = Path(environment.subst("$BUILD_DIR"))
    folder.mkdir(parents=True, exist_ok=True)
    source = Path(environment.subst("$PROJECT_DIR")) / "hk_boot2_rp2040.S"
    assembled, binary = folder / "hk_boot2.o", folder / "hk_boot2.bin"
    run = {"check": True, "env": environment["ENV"]}
    subprocess.run(["arm-none-eabi-gcc", *CPU, "-c", "-o", str(assembled), str(source)], **run)
    subprocess.run(
        ["arm-none-eabi-objcopy", "-O", "binary", "-j", ".boot2", str(assembled), str(binary)],
        **run,
    )
    held = folder / "hk_boot2_crc.S"
    held.write_text(
        f'.section .boot2_crc, "a"\n.word 0x{checksum(binary.read_bytes()):08X}\n', encoding="ascii"
    )
    return held


env = DefaultEnvironment()
held = loader_checksum(env)
env.Append(LINKFLAGS=[*CPU, "-nostartfiles", "-Wl,--gc-sections"])
env.Append(PIOBUILDFILES=[env.Object(str(held.with_suffix(".o")), str(held))])
