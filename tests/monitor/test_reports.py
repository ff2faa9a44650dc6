import functools
import json
import math
import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from designs import design
from device import Device
from judging import feed

from hostkit.filters.filter import Fact
from hostkit.link.frames.decoder import Decoder
from hostkit.link.statistics import LinkStatistics, SourceStatistics, Spread, TimingStatistics
from hostkit.monitor.collect import MOST_POINTS, JitterCollector, OverlayCollector
from hostkit.monitor.document import monitor_document
from hostkit.monitor.result import SessionResult
from hostkit.monitor.snapshot import Batch, DeviceStatus, Notice, SessionInfo
from hostkit.report.junit import junit_xml, write_junit
from hostkit.report.monitor import monitor_page, write_monitor_report
from hostkit.report.plain_text import plain_text
from hostkit.validation import Thresholds, Validator

HOSTILE = "\x00\x1b[31m<script>alert(1)</script>\u202e\ud800]]>&'\"\uffff"
SAMPLES = 300
INFO = SessionInfo(
    design_digest="0123456789ab",
    axes=("roll", "pitch"),
    rate_hz=100.0,
    filter="complementary filter",
    facts=(
        Fact(name="eta", label="eta", value=0.9965),
        Fact(name="tau_s", label="tau", value=1.4236, unit="s"),
    ),
    port="/dev/ttyUSB0",
    replay=False,
    hostkit_version="0",
)
LINK = LinkStatistics(
    received_bytes=30_000,
    frames=301,
    lost_frames=2,
    bad=1,
    bad_bytes=7,
    sources=(SourceStatistics(system=1, component=1, frames=301, lost=2),),
)
TIMING = TimingStatistics(
    round_trip_ms=1.25, clock_ppm=-40.0, jitter=Spread(median_ms=0.5, p95_ms=2.0, max_ms=9.0)
)


def arrived(jitter: JitterCollector, time_us: int, received_ns: int) -> None:
    jitter.arrived(np.array([time_us]), np.array([received_ns]))


def batch_of(judged) -> Batch:
    return Batch(
        time_s=judged.time_us * 1e-6,
        received_s=0.0,
        device_rad=judged.device_rad.copy(),
        model_rad=judged.model_rad.copy(),
        residual_rad=judged.residual_rad.copy(),
        mismatch=judged.mismatch.copy(),
        begins=judged.begins.copy(),
    )


def session_result(frames=None, *, thresholds=None, other_digest=None, **changes) -> SessionResult:
    thresholds = thresholds or Thresholds()
    validator, overlay, jitter = Validator(design()), OverlayCollector(2), JitterCollector()
    frames = Device(design()).frames(SAMPLES) if frames is None else frames
    for k, judged in enumerate(feed(validator, Decoder(), frames, design())):
        overlay.add(batch_of(judged))
        arrived(jitter, 370_000 * k, 370_000_000 * k + k * k * 10_000)
    result = SessionResult(
        report=validator.report(thresholds, other_digest=other_digest),
        link=LINK,
        duration_s=3.0,
        thresholds=thresholds,
        timing=TIMING,
        info=INFO,
        overlay=overlay.overlay(),
        residual_histogram=validator.histograms(),
        jitter_histogram=jitter.histogram(),
    )
    return replace(result, **changes)


RETUNED = {
    100: {"FILT_TAU": 0.5},
}
CASES = {
    "pass": session_result(),
    "fail": session_result(thresholds=Thresholds(max_lag_ms=0.0, max_drift_deg_min=1.0)),
    "refused": session_result([], other_digest="ba9876543210"),
    "nothing": session_result([]),
    "retuned": session_result(Device(design()).retuned_frames(SAMPLES, RETUNED)),
    "bare": SessionResult(
        report=Validator(design()).report(Thresholds()), link=LinkStatistics(), duration_s=0.0
    ),
    "hostile": session_result(
        device=DeviceStatus(texts=(HOSTILE, "x" * 10_000), version=HOSTILE),
        notices=(Notice(time_s=0.0, level="warning", text=HOSTILE),),
        info=replace(INFO, port=HOSTILE),
    ),
}


@functools.cache
def page_of(case: str) -> str:
    return monitor_page(CASES[case])


class Checker(HTMLParser):
    """Collects tags, what they point to, and whether they are closed."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.tags: list[str] = []
        self.outside: list[str] = []

    def handle_starttag(self, tag: str, attrs) -> None:
        self.tags.append(tag)
        if tag not in ("meta", "br", "use", "path") or self.get_starttag_text().endswith("/>"):
            self.open.append(tag)
        for name, value in attrs:
            if name in ("src", "href", "xlink:href", "action") and not value.startswith("#"):
                self.outside.append(value)

    def handle_startendtag(self, tag: str, attrs) -> None:
        self.tags.append(tag)

    def handle_endtag(self, tag: str) -> None:
        while self.open and self.open.pop() != tag:
            pass


@pytest.mark.parametrize("case", CASES)
def test_the_page_is_one_file_without_script_or_outside_request(case: str) -> None:
    page = page_of(case)
    checker = Checker()
    checker.feed(page)
    assert not {"script", "iframe", "img", "link", "object", "embed"} & set(checker.tags)
    assert checker.outside == []
    assert "\x00" not in page
    assert "\u202e" not in page
    page.encode("utf-8")


def test_the_page_is_the_same_bytes_whenever_it_is_made() -> None:
    assert page_of("pass") == monitor_page(CASES["pass"])


@pytest.mark.parametrize(("case", "figures"), [("pass", 3), ("refused", 0), ("bare", 0)])
def test_the_page_shows_the_verdict_and_the_figures(case: str, figures: int) -> None:
    page = page_of(case)
    assert f"verdict: {CASES[case].report.verdict}" in page
    assert page.count("<figure") == figures


def test_the_page_names_what_it_stands_on() -> None:
    page = page_of("retuned")
    for text in ("FILT_TAU", "/dev/ttyUSB0", "0123456789ab", "1.1", "1.250 ms", "-40.0 ppm"):
        assert text in page
    assert "could not be measured" in page_of("fail")
    assert "&lt;script&gt;" in page_of("hostile")


def cases_of(result: SessionResult) -> dict[str, ElementTree.Element]:
    suite = ElementTree.fromstring(junit_xml(result)).find("testsuite")
    cases = {case.get("name"): case for case in suite.findall("testcase")}
    for attribute, tag in (("failures", "failure"), ("skipped", "skipped")):
        assert int(suite.get(attribute)) == sum(c.find(tag) is not None for c in cases.values())
    assert int(suite.get("tests")) == len(cases)
    return cases


@pytest.mark.parametrize("case", CASES)
def test_junit_is_xml_and_agrees_with_the_verdict(case: str) -> None:
    cases = cases_of(CASES[case])
    failed = [name for name, element in cases.items() if element.find("failure") is not None]
    assert bool(failed) == (CASES[case].report.verdict != "pass")


def test_junit_has_a_case_for_every_threshold() -> None:
    cases = cases_of(CASES["fail"])
    names = " ".join(cases)
    for name in ("design", "steps", "residual rms", "lost samples", "lag at most 0 ms", "drift"):
        assert name in names
    drift = cases["drift at most 1 deg/min"].find("failure").get("message")
    assert drift == "the drift could not be measured, and at most 1 deg/min is asked for"
    refused = cases_of(CASES["refused"])
    assert "ba9876543210" in refused["design"].find("failure").get("message")
    assert refused["steps at most 0"].find("skipped") is not None


def test_junit_names_a_reason_that_no_check_gave() -> None:
    report = replace(CASES["pass"].report, verdict="fail", reasons=("the recording has an end",))
    cases = cases_of(replace(CASES["pass"], report=report))
    assert cases["session"].find("failure").get("message") == "the recording has an end"


def test_the_document_keeps_its_keys_and_is_json() -> None:
    for result in CASES.values():
        json.dumps(monitor_document(result), allow_nan=False)
    document = monitor_document(CASES["retuned"])
    assert document["schema"] == "hostkit.monitor/1"
    assert set(document) >= {
        *("samples", "checked", "lost", "lost_frames", "bad", "bad_bytes", "unknown", "rms_deg"),
        *("max_deg", "mismatches", "digest_ok", "duration_s", "verdict", "reasons"),
    }
    assert document["max_deg"] == math.degrees(CASES["retuned"].report.max_rad)
    assert [entry["axis"] for entry in document["residual"]] == ["roll", "pitch"]
    assert document["retuned"][0]["device_value"] == 0.5
    assert document["checks"][0] == {
        "name": "steps",
        "figure": "0 of 300 wrong",
        "limit": "0",
        "kept": True,
        "reason": "",
    }
    assert document["link"]["sources"][0]["lost"] == 2


def test_reports_are_written_whole(tmp_path: Path) -> None:
    write_monitor_report(CASES["hostile"], tmp_path / "report.html")
    write_junit(CASES["hostile"], tmp_path / "report.xml")
    assert (tmp_path / "report.html").read_text("utf-8").endswith("</html>\n")
    ElementTree.parse(tmp_path / "report.xml")


def test_text_is_made_plain() -> None:
    assert plain_text("a\tb\u00a0c\u00e9") == "a b c\u00e9"
    assert re.fullmatch("\ufffd*", plain_text("\x00\x7f\u202e\ud800\uffff\u200b"))
    assert plain_text("x" * 600) == "x" * 500 + "..."


@pytest.mark.parametrize("samples", [10, MOST_POINTS, 7 * MOST_POINTS + 5, 40 * MOST_POINTS])
def test_the_overlay_is_bounded_and_keeps_the_greatest_residual(samples: int) -> None:
    rng = np.random.default_rng(5)
    collector = OverlayCollector(2)
    residual = rng.normal(0.0, 1e-6, (samples, 2))
    residual[samples // 2] = (-0.5, 0.25)
    residual[0] = np.nan
    begins = np.zeros(samples, dtype=np.bool_)
    begins[[0, samples // 3]] = True
    for i in range(0, samples, 1009):
        part = slice(i, i + 1009)
        device = np.ones_like(residual[part])
        collector.add(
            Batch(
                time_s=np.arange(samples, dtype=float)[part] * 0.01,
                received_s=0.0,
                device_rad=device,
                model_rad=device.copy(),
                residual_rad=residual[part].copy(),
                mismatch=np.zeros(len(device), dtype=np.bool_),
                begins=begins[part].copy(),
            )
        )
    overlay = collector.overlay()
    # What is not enough for a point yet is kept too.
    assert len(overlay.time_s) <= 2 * MOST_POINTS + overlay.samples_per_point
    assert (np.diff(overlay.time_s) > 0.0).all()
    assert (np.nanmin(overlay.residual_rad), np.nanmax(overlay.residual_rad)) == (-0.5, 0.25)
    assert overlay.begins.sum() == 2
    assert overlay.time_s[-1] * 100 > samples - 1 - overlay.samples_per_point


def test_the_jitter_is_what_an_arrival_is_off_its_samples() -> None:
    collector = JitterCollector()
    for k in range(11):
        arrived(collector, k * 10_000, k * 10_000_000 + (k % 2) * 1_000_000)
    collector.begin_epoch()
    arrived(collector, 0, 99)
    shown = collector.histogram()
    assert shown.counts.sum() == 10
    assert shown.edges[0] <= 1e-3 < shown.edges[-1]
