"""Comparing filters: hostkit's and those of other packages, on the same recordings."""

import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from hostkit.comparison.calibration import AS_READ, correction_of, readings_of
from hostkit.comparison.options import CompareOptions
from hostkit.comparison.own import default_row, design_row, lead_of, tuned_row
from hostkit.comparison.peer import Peer
from hostkit.comparison.peers import chosen_peers
from hostkit.comparison.problem import PeerProblem
from hostkit.comparison.row import Row
from hostkit.comparison.smoothed import smoother_row
from hostkit.comparison.tuned import tuned
from hostkit.errors import RecordingError, ToolMissingError
from hostkit.optimisers import qpso
from hostkit.recordings import Recording
from hostkit.records import FilterDesign
from hostkit.tuning import TUNERS, TuningOptions
from hostkit.tuning.evaluation import Quantity, require_rate

PARTICLES = 20
SCALE_BUDGET = 60
"""With fewer evaluations three more numbers cannot be searched."""

Progress = Callable[[str], None]


def silent(message: str) -> None:
    """Take a message and say nothing."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Missing:
    """A peer that cannot run, and why."""

    name: str
    reason: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Comparison:
    """Filters on the same recordings.

    Attributes
    ----------
    quantity
        What the errors are of.
    recordings
        Their names, in the order of the errors.
    rows
        Filters with their settings, hostkit's first.
    missing
        Peers that are not there.
    lead_s
        How far every filter that can was told ahead.
    design
        The design that was compared, if there was one.
    trained_on
        How many of the recordings that design was tuned on.
    """

    quantity: Quantity
    recordings: tuple[str, ...]
    samples: int
    rows: tuple[Row, ...]
    missing: tuple[Missing, ...]
    lead_s: float
    calibrated_peers: bool
    design: FilterDesign | None = None
    trained_on: int = 0


def compare(
    recordings: tuple[Recording, ...], options: CompareOptions, progress: Progress = silent
) -> Comparison:
    """Run filters over recordings that have a reference.

    Raises
    ------
    RecordingError
        If there is no recording, one has no reference or no valid sample, or the rates differ.
    DesignError
        If peers are to be calibrated by a design without a calibration.
    HostkitError
        If a peer has another name.
    """
    options = _with_design(options)
    if not recordings:
        raise RecordingError("there is no recording to compare on; name at least one")
    for recording in recordings:
        require_rate(recordings[0].rate_hz, recording)
    peers = chosen_peers(options.peers)
    rows = [*_own_rows(recordings, options, progress)]
    found, missing = _peer_rows(recordings, options, peers, progress)
    return Comparison(
        quantity=_quantity(options),
        recordings=tuple(recording.name for recording in recordings),
        samples=sum(len(recording) for recording in recordings),
        rows=(*rows, *found),
        missing=missing,
        lead_s=options.lead_s or 0.0,
        calibrated_peers=options.calibrated_peers,
        design=options.design,
        trained_on=_trained_on(recordings, options.design),
    )


def _with_design(options: CompareOptions) -> CompareOptions:
    """Take axes, mounting and lead from the design, if there is one."""
    design = options.design
    if design is None:
        return options
    lead_s = lead_of(design) if options.lead_s is None else options.lead_s
    return replace(options, axes=design.axes, mounting=design.mounting, lead_s=lead_s)


def _quantity(options: CompareOptions) -> Quantity:
    return "inclination" if options.axes == "both" else options.axes


def _trained_on(recordings: tuple[Recording, ...], design: FilterDesign | None) -> int:
    if design is None or design.tuning is None:
        return 0
    known = {one.sha256 for one in design.tuning.recordings if one.sha256}
    return sum(recording.sha256 in known for recording in recordings)


def _own_rows(
    recordings: tuple[Recording, ...], options: CompareOptions, progress: Progress
) -> Iterator[Row]:
    lead_s = options.lead_s or 0.0
    if options.design is not None:
        progress(f"{options.design.filter}: the design")
        yield design_row(recordings, options.design, lead_s)
    else:
        for tuner in TUNERS:
            progress(f"{tuner.name}: defaults{' and tuning' if options.tune else ''}")
            tuning = _tuning_options(options, tuner.name, options.evaluations)
            yield default_row(recordings, tuning, lead_s)
            if options.tune:
                with tempfile.TemporaryDirectory(prefix="hostkit-") as folder:
                    yield tuned_row(
                        recordings, tuning, lead_s, Path(folder), with_scale=options.gyro_scale
                    )
    if any(peer.is_offline for peer in chosen_peers(options.peers)):
        progress("hostkit smooth")
        yield from smoother_row(recordings, _quantity(options), options.mounting, lead_s)


def _tuning_options(options: CompareOptions, name: str, evaluations: int) -> TuningOptions:
    particles = min(PARTICLES, max(4, evaluations // 4))
    return TuningOptions(
        filter=name,
        axes=options.axes,
        mounting=options.mounting,
        particles=particles,
        iterations=max(1, evaluations // particles - 1),
        seed=options.seed,
        jobs=options.jobs,
        held_out=options.held_out,
        resamples=0,
    )


def _peer_rows(
    recordings: tuple[Recording, ...],
    options: CompareOptions,
    peers: tuple[Peer, ...],
    progress: Progress,
) -> tuple[tuple[Row, ...], tuple[Missing, ...]]:
    design = options.design if options.calibrated_peers else None
    correction = AS_READ if design is None else correction_of(design)
    readings = tuple(readings_of(recording, correction) for recording in recordings)
    rows: list[Row] = []
    missing: list[Missing] = []
    for peer in peers:
        problem = PeerProblem(
            peer=peer,
            readings=readings,
            quantity=_quantity(options),
            mounting=options.mounting,
            lead_s=options.lead_s or 0.0,
        )
        progress(f"{peer.title}: defaults{' and tuning' if options.tune else ''}")
        try:
            rows += _rows_of(problem, options)
        except ToolMissingError as error:
            missing.append(Missing(name=peer.name, reason=str(error)))
    return tuple(rows), tuple(missing)


def _rows_of(problem: PeerProblem, options: CompareOptions) -> Iterator[Row]:
    peer, space = problem.peer, problem.space
    row = Row(
        name=peer.name,
        title=peer.title,
        origin="peer",
        settings="default",
        is_offline=peer.is_offline,
        lead_s=problem.lead_s,
        each_rad=tuple(problem.each_rms_rad(peer.defaults).tolist()),
        parameters=space.design_parameters(space.start),
    )
    yield row
    if not options.tune:
        return
    planned = peer.evaluations(options.evaluations)
    problem = replace(problem, is_scaled=options.gyro_scale and planned >= SCALE_BUDGET)
    space = problem.space
    tuning = replace(_tuning_options(options, peer.name, planned), optimiser=qpso.NAME)
    found = tuned(problem, space.start, tuning)
    yield replace(
        row,
        settings="tuned",
        is_scaled=problem.is_scaled,
        each_rad=found.each_rad,
        held_out=found.held_out,
        parameters=space.design_parameters(found.x),
        evaluations=found.evaluations,
    )
