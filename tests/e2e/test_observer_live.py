"""The observer on served boards under the real monitor: met in mid-flight, tuned, disturbed."""

import contextlib
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from boards import TARGET_TOOLS, require_or_skip
from disturb import DisturbedTransport, Disturber, Harm
from live import browser, emulated, program, until, watched_page

from hostkit.design_file import save_design
from hostkit.filters.observer import OBSERVER, default_parameters
from hostkit.link.ports.transport import open_transport
from hostkit.monitor import Session, SessionOptions, SessionResult
from hostkit.monitor.snapshot import Batch, Controls, Snapshot
from hostkit.mounting import Mounting
from hostkit.recordings import save
from hostkit.records import FilterDesign, SensorConfig
from hostkit.simulation import SensorErrors, simulate
from hostkit.validation import Thresholds

DESIGN = FilterDesign(
    filter="observer",
    axes="both",
    tilt="atan2",
    mounting=Mounting(),
    rate_hz=100.0,
    sensor=SensorConfig(
        part="mpu6050", gyro_full_scale_deg_s=500, accel_full_scale_g=4, low_pass_setting=3
    ),
    parameters=default_parameters(),
)
NEW_KT, NEW_BIAS_RAD_S = 0.03, 0.01
BAUD = 500_000
STEPS, LONGEST_S = 150, 60.0
LOSSES = Harm(drop=0.02, burst=0.004)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A design, a motion, and one with pauses in which a gyroscope can be calibrated."""
    path = tmp_path_factory.mktemp("observer")
    save_design(DESIGN, path / "design.json")
    for profile in ("sine-sweep", "steps"):
        recording = simulate(
            profile,
            duration_s=10.0,
            rate_hz=DESIGN.rate_hz,
            sensor=DESIGN.sensor,
            errors=SensorErrors(),
            rng=np.random.default_rng(1),
        )
        save(recording, path / f"{profile}.csv")
    return path


@dataclass
class Story:
    """Acts of a session: each begins once the one before it is done and so many steps judged."""

    controls: Controls
    acts: list[tuple[Callable[[], None], Callable[[Snapshot], bool]]]
    end: Callable[[], None]
    checked: int = 0
    _begun: bool = False

    def take_batch(self, batch: Batch) -> None:
        """See samples."""

    def take_snapshot(self, snapshot: Snapshot) -> None:
        if snapshot.report.checked < self.checked + STEPS:
            return
        if not self.acts:
            self.end()
        elif not self._begun:
            if snapshot.parameters:
                self.acts[0][0]()
                self._begun = True
        elif self.acts[0][1](snapshot):
            self.acts.pop(0)
            self._begun, self.checked = False, snapshot.report.checked


def uses(name: str, value: float) -> Callable[[Snapshot], bool]:
    def asked(snapshot: Snapshot) -> bool:
        told = {p.name: p.value for p in snapshot.parameters}
        return told.get(name) == pytest.approx(value, rel=1e-4)

    return asked


def is_calibrated(snapshot: Snapshot) -> bool:
    return snapshot.command is not None and snapshot.command.state == "accepted"


@contextlib.contextmanager
def port_of(folder: Path, target: str, recording: str) -> Iterator[str]:
    require_or_skip(*TARGET_TOOLS[target])
    with emulated(folder / "design.json", target, folder / f"{recording}.csv") as port:
        yield port


@pytest.mark.parametrize("target", ["host", "atmega328p"])
def test_steps_equal_the_model_whatever_is_set_and_lost(target: str, folder: Path) -> None:
    with port_of(folder, target, "steps") as port:
        result, dropped = watched(port)
    report = result.report
    assert (report.verdict, report.reasons) == ("pass", ())
    assert (report.mismatches, report.digest_ok) == (0, True)
    assert report.checked >= 5 * STEPS
    assert 0 < report.waiting <= report.unjudged
    assert 10 < report.lost <= dropped
    changed = {p.name: p.device_value for p in report.retuned}
    assert changed["FILT_KT"] == pytest.approx(NEW_KT, rel=1e-4)
    assert {f"GYRO_BIAS_{axis}" for axis in "XYZ"} < set(changed)


def watched(port: str) -> tuple[SessionResult, int]:
    """Set a gain and a bias, calibrate, lose frames; each with enough steps behind it."""
    disturber = Disturber(1, LOSSES)
    disturber.calm = True
    with contextlib.closing(open_transport(port, BAUD)) as transport:
        session = Session(
            design=DESIGN,
            transport=DisturbedTransport(transport, disturber),
            thresholds=Thresholds(max_lost_share=1.0),
            duration_s=LONGEST_S,
            options=SessionOptions(port=port),
        )
        controls = session.controls

        def disturbs() -> None:
            disturber.calm = False

        session.views.append(
            Story(
                controls,
                [
                    (lambda: controls.set_parameter("FILT_KT", NEW_KT), uses("FILT_KT", NEW_KT)),
                    (
                        lambda: controls.set_parameter("GYRO_BIAS_Z", NEW_BIAS_RAD_S),
                        uses("GYRO_BIAS_Z", NEW_BIAS_RAD_S),
                    ),
                    (lambda: controls.command("calibrate"), is_calibrated),
                    (disturbs, lambda snapshot: snapshot.report.lost > 10),
                ],
                session.stop,
            )
        )
        result = session.run()
    return result, disturber.expected().lost_frames


def test_the_page_shows_the_observer_and_its_parameters(folder: Path) -> None:
    arguments = ["monitor", "design.json", "--port"]
    with contextlib.ExitStack() as stack:
        port = stack.enter_context(port_of(folder, "host", "sine-sweep"))
        chromium = stack.enter_context(browser())
        monitor = stack.enter_context(program(folder, *arguments, port, "--web", "--no-browser"))
        with watched_page(chromium, monitor.see(r"http://\S+")) as page:
            sees_facts_and_parameters(page)
        assert monitor.end() == 0, monitor.said


def sees_facts_and_parameters(page) -> None:
    labels = [fact.label for fact in OBSERVER.facts(DESIGN)]
    design, body = page.locator("#design-name"), page.locator("body")
    for label in labels[:2]:
        until(page, lambda x=label: f"{x} " in design.inner_text(), label)
    title = design.get_attribute("title")
    assert OBSERVER.title in title
    assert all(f"{label} " in title for label in labels)
    for known in OBSERVER.run_time.known:
        until(page, lambda x=known.name: x in body.inner_text(), known.name)
