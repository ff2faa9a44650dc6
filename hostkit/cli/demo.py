"""The subcommand ``demo``: the whole loop without hardware."""

import contextlib
import math
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import TypeVar

import click
import numpy as np

from hostkit.cli.inputs import JSON, say
from hostkit.cli.output import emit_json
from hostkit.design_file import digest, save_design
from hostkit.emulation.board import BuildResult
from hostkit.emulation.run import EmulationResult, build, emulate
from hostkit.errors import EmulationError, HostkitError, ToolMissingError, VerdictError
from hostkit.filters import FILTERS
from hostkit.link.ports.transport import open_transport
from hostkit.monitor import Session, SessionResult
from hostkit.optimisers import qpso
from hostkit.recordings import Recording, load, save
from hostkit.records import FilterDesign, SensorConfig
from hostkit.render import generate, write
from hostkit.report.demo import DemoResult, Step, write_demo_report
from hostkit.simulation import SensorErrors, simulate
from hostkit.targets import TARGETS, Target
from hostkit.tuning import TuningOptions, TuningResult, evaluate, tune
from hostkit.validation import Thresholds

RATE_HZ = 100.0
DURATION_S = 30.0
VIBRATION_M_S2 = 2.0
SENSOR = SensorConfig(
    part="mpu6050", gyro_full_scale_deg_s=500, accel_full_scale_g=4, low_pass_setting=3
)
LIVE_S = 5.0
PTY_WAIT_S = 60.0
LEFT_OUT = "left out"
LIVE_TARGETS = ("atmega328p", "host")
"""Boards to watch live, the best first."""

T = TypeVar("T")


class Steps:
    """Runs steps one after the other, shows each, and remembers how it went."""

    def __init__(self) -> None:
        self.done: list[Step] = []

    def run(self, name: str, action: Callable[[], tuple[T, str]]) -> T:
        """Run a step that must go well; it returns its result and one line about it."""
        begun = time.monotonic()
        self._show(f"  ... {name}", end="")
        try:
            result, detail = action()
        except HostkitError as error:
            self._finish(name, False, str(error), begun)
            raise
        self._finish(name, True, detail, begun)
        return result

    def attempt(self, name: str, action: Callable[[], tuple[T, str]]) -> T | None:
        """Run a step that may be left out where its tools are not installed."""
        try:
            return self.run(name, action)
        except ToolMissingError as error:
            self.done[-1] = Step(name=name, ok=True, detail=f"{LEFT_OUT}: {error}")
            return None

    def _finish(self, name: str, ok: bool, detail: str, begun: float) -> None:
        self.done.append(Step(name=name, ok=ok, detail=detail))
        mark = "ok" if ok else "--"
        self._show(f"\r  {mark:3} {name}: {detail} ({time.monotonic() - begun:.1f} s)")

    @staticmethod
    def _show(text: str, end: str = "\n") -> None:
        if end or sys.stderr.isatty():
            click.echo(text, nl=bool(end), err=True)


@click.command("demo")
@click.option(
    "--out",
    type=click.Path(file_okay=False, path_type=Path),
    default=Path("demo"),
    show_default=True,
    metavar="DIR",
    help="Folder for recordings, design, code and report.",
)
@click.option("--seed", type=click.IntRange(0, 2**63 - 1), default=1, show_default=True)
@JSON
def demo(out: Path, seed: int, as_json: bool) -> None:
    """Run the whole loop without hardware and end in a report.

    Simulates two recordings, tunes on one, renders C and VHDL, builds them, runs them on the other
    recording, watches an emulated board live over a pseudo-terminal, and writes an HTML report.

    \b
    Example:
      hostkit demo --out demo
    """
    report = out / "report.html"
    result = run_demo(out, seed)
    write_demo_report(result, report)
    if as_json:
        emit_json(
            {
                "schema": "hostkit.demo/1",
                "verdict": result.verdict,
                "steps": [{"name": s.name, "ok": s.ok, "detail": s.detail} for s in result.steps],
                "report": str(report),
            }
        )
    else:
        left_out = [step.name for step in result.steps if step.detail.startswith(LEFT_OUT)]
        remark = f" (left out: {', '.join(left_out)})" if left_out else ""
        click.echo(f"report: {report}\nverdict: {result.verdict}{remark}")
    if result.verdict != "pass":
        raise VerdictError("the demo did not pass; the report says where")


def run_demo(out: Path, seed: int) -> DemoResult:
    """Do all steps of the demo in a folder, and judge."""
    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise HostkitError(f"{out} cannot be made: {error.strerror}") from error
    steps = Steps()
    training = steps.run("simulate", lambda: _simulate(out / "training.csv", "steps", seed))
    other = steps.run("simulate", lambda: _simulate(out / "held-out.csv", "sine-sweep", seed + 1))
    tuning = steps.run("tune", lambda: _tune(training, out / "design.json", seed))
    held_out = evaluate(tuning.design, other)
    emulations = []
    for target in TARGETS:
        found = steps.attempt(
            target.name,
            partial(_emulate, target, tuning.design, other, out),
        )
        if found is not None:
            emulations.append(found)
    session = _live(steps, tuning.design, out, tuple(e.target for e, _ in emulations))
    passed = all(e.passed for e, _ in emulations) and bool(emulations)
    passed = passed and (session is None or session.report.verdict == "pass")
    return DemoResult(
        verdict="pass" if passed else "fail",
        steps=tuple(steps.done),
        tuning=tuning,
        held_out=held_out,
        emulations=tuple(emulations),
        session=session,
    )


def _simulate(path: Path, profile: str, seed: int) -> tuple[Recording, str]:
    recording = simulate(
        profile,
        duration_s=DURATION_S,
        rate_hz=RATE_HZ,
        sensor=SENSOR,
        errors=SensorErrors(vibration_m_s2=VIBRATION_M_S2),
        rng=np.random.default_rng(seed),
    )
    save(recording, path)
    return load(path), f"{path}, {len(recording)} samples, profile {profile}"


def _tune(recording: Recording, path: Path, seed: int) -> tuple[TuningResult, str]:
    options = TuningOptions(
        seed=seed, sensor=SENSOR, free=("tau", "tilt_offset"), optimiser=qpso.NAME
    )
    result = tune((recording,), options)
    save_design(result.design, path)
    error = math.degrees(result.rms_rad)
    first = FILTERS[result.design.filter].facts(result.design)[0].text()
    return result, f"{path}, design {digest(result.design)}, {first}, {error:.3f} deg RMSE"


def _emulate(
    target: Target, design: FilterDesign, recording: Recording, out: Path
) -> tuple[tuple[EmulationResult, BuildResult | None], str]:
    folder = out / target.name
    write(generate(design, target), folder)
    built = build(folder, target)
    result = emulate(folder, target, design, recording)
    image = built if isinstance(built, BuildResult) else None
    detail = f"{result.samples} samples, {result.missing} missing, {result.mismatches} mismatches"
    return (result, image), detail


def _live(
    steps: Steps, design: FilterDesign, out: Path, ran: tuple[str, ...]
) -> SessionResult | None:
    """Watch the best board that ran, through the same commands that a user would give."""
    target = next((name for name in LIVE_TARGETS if name in ran), None)
    if target is None:
        say("  no board ran, so there is nothing to watch live")
        return None

    def watch() -> tuple[SessionResult, str]:
        with _served(target, out) as port:
            transport = open_transport(port, TARGETS[target].baud)
            try:
                result = Session(
                    design=design,
                    transport=transport,
                    thresholds=Thresholds(),
                    duration_s=LIVE_S,
                ).run()
            finally:
                transport.close()
        report = result.report
        return result, (
            f"{target} over a pseudo-terminal: {report.samples} samples, {report.lost} lost, "
            f"{report.mismatches} mismatches, verdict {report.verdict}"
        )

    return steps.run("monitor", watch)


@contextlib.contextmanager
def _served(target: str, out: Path) -> Iterator[str]:
    """Serve a board in a process of its own; give the path of its pseudo-terminal."""
    command = [sys.executable, "-m", "hostkit", "emulate", str(out / "design.json"), "--pty"]
    command += ["--target", target, "--recording", str(out / "held-out.csv")]
    command += ["--code", str(out / target)]
    with subprocess.Popen(
        command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as server:
        try:
            assert server.stdout is not None
            port = server.stdout.readline().strip()
            if not port:
                said = server.communicate(timeout=PTY_WAIT_S)[1].strip()
                raise EmulationError(f"{target} cannot be served: {said[-300:]}")
            yield port
        finally:
            server.send_signal(signal.SIGINT)
            try:
                server.communicate(timeout=PTY_WAIT_S)
            except subprocess.TimeoutExpired:
                server.kill()
