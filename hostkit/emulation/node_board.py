"""Boards whose CPU emulator runs under Node.js: the image, the virtual sensor on its bus."""

import dataclasses
import tempfile
from dataclasses import dataclass
from pathlib import Path

from hostkit.emulation.board import (
    BoardRun,
    BuildResult,
    Progress,
    Receive,
    Send,
    Stimulus,
    Stop,
    nothing_received,
)
from hostkit.emulation.child import collect, stream
from hostkit.emulation.image import build_image
from hostkit.emulation.playback import (
    Playback,
    board_run,
    playback,
    require_end,
    run_timeout_s,
)
from hostkit.emulation.tools import require
from hostkit.emulation.virtual_sensor import compiled_wasm
from hostkit.errors import BuildError

SCRIPT = "board.mjs"


@dataclass(frozen=True, slots=True, kw_only=True)
class NodeBoard:
    """A board with an image that a script of this room runs.

    Attributes
    ----------
    emulator
        The npm package of the CPU; the script stands in a folder of its name.
    toolchain
        What the names of its compiler and its tools begin with.
    image
        What its Makefile builds, and what would be flashed.
    build_tools
        Programs that a build needs beside make and the compiler.
    """

    emulator: str
    toolchain: str
    image: str
    build_tools: tuple[str, ...] = ()

    def build(self, folder: Path) -> BuildResult:
        """Build a generated folder and measure the image.

        Raises
        ------
        BuildError
            If the code does not compile; the message is the compiler's first error.
        ToolMissingError
            If make or the compiler is not installed.
        """
        require(*self.build_tools)
        return build_image(folder, toolchain=self.toolchain, image=self.image)

    def run(
        self, folder: Path, stimulus: Stimulus, *, progress: Progress | None = None
    ) -> BoardRun:
        """Play a stimulus to its end, as fast as the emulator can.

        Raises
        ------
        BuildError
            If the folder has not been built.
        EmulationError
            If the emulator fails or hangs, or the stimulus loops.
        ToolMissingError
            If node, the emulator, clang or its linker is not installed.
        """
        require_end(stimulus)
        with tempfile.TemporaryDirectory(prefix="hostkit-board-") as name:
            play = playback(stimulus, Path(name))
            command = self._command(folder, play)
            if progress is not None:
                command.append("--progress")
            heard = collect(command, timeout_s=run_timeout_s(stimulus), progress=progress)
            return board_run(play, heard, progress)

    def serve(
        self,
        folder: Path,
        stimulus: Stimulus,
        send: Send,
        stop: Stop,
        receive: Receive = nothing_received,
    ) -> None:
        """Play a stimulus over and over in real time until `stop` says so.

        Raises
        ------
        BuildError
            If the folder has not been built.
        EmulationError
            If the emulator ends by itself.
        ToolMissingError
            If node, the emulator, clang or its linker is not installed.
        """
        with tempfile.TemporaryDirectory(prefix="hostkit-board-") as name:
            play = playback(dataclasses.replace(stimulus, loop=True), Path(name))
            stream(self._command(folder, play), send, stop, receive)

    def _command(self, folder: Path, play: Playback) -> list[str]:
        require("node", self.emulator)
        image = folder.resolve() / self.image
        if not image.is_file():
            raise BuildError(f"{folder} has not been built yet")
        sensor = compiled_wasm(folder.resolve())
        script = Path(__file__).parent / self.emulator / SCRIPT
        files = ("--image", str(image), "--sensor", str(sensor), "--table", str(play.table))
        return ["node", str(script), *files, *play.options]
