"""Which filter ``tune`` takes: what it says of the motion, and the choice if it is left to it."""

from collections import Counter
from dataclasses import replace
from typing import Final

from hostkit.cli.inputs import say
from hostkit.cli.parameter_options import AUTO_FILTER
from hostkit.diagnosis import Diagnosis, diagnose, findings, recommended_for_all
from hostkit.errors import HostkitError
from hostkit.filters import FILTERS
from hostkit.recordings import LargeRecording, Recording
from hostkit.tuning import TuningOptions

MOST_SHOWN: Final = 3
"""Recordings whose motion is called unfit one by one."""


def with_filter(
    recordings: tuple[Recording | LargeRecording, ...], options: TuningOptions
) -> TuningOptions:
    """Say what the motion calls for, before anything is tuned, and take it if that was asked for.

    Raises
    ------
    HostkitError
        If the filter is to be found, and the recordings do not show enough motion to tell.
    """
    diagnoses = []
    for recording in recordings:
        part = recording.head if isinstance(recording, LargeRecording) else recording
        diagnoses.append(diagnose(part, axes=options.axes, mounting=options.mounting))
    verdicts = Counter(d.planarity.verdict or "cannot be judged" for d in diagnoses)
    counts = ", ".join(f"{verdict} ({count})" for verdict, count in verdicts.items())
    say(f"motion of {len(recordings)} recording(s): {counts}")
    recommended = recommended_for_all(tuple(diagnoses))
    if recommended is None:
        if options.filter == AUTO_FILTER:
            raise HostkitError(
                "the motion of the recordings cannot be judged (hostkit diagnose says why), so it "
                "calls for no filter in particular: name one with --filter: "
                f"{', '.join(FILTERS.names())}"
            )
        _say_unfit(diagnoses)
        return options
    say(f"recommended: --filter {recommended.filter}: {recommended.reason}")
    if options.filter == AUTO_FILTER:
        return replace(options, filter=recommended.filter)
    if options.filter != "observer":
        _say_unfit(diagnoses)
    return options


def _say_unfit(diagnoses: list[Diagnosis]) -> None:
    """Say of which recordings the motion is not one for filters of single angles."""
    unfit = []
    for diagnosis in diagnoses:
        motion = next(f for f in findings(diagnosis) if f.topic == "motion")
        if motion.level == "look":
            unfit.append(f"{diagnosis.name}: {motion.sentence} -> {motion.action}")
    for line in unfit[:MOST_SHOWN]:
        say(f"  {line}")
    if len(unfit) > MOST_SHOWN:
        say(f"  and {len(unfit) - MOST_SHOWN} more; hostkit diagnose shows them")
