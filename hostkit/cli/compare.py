"""The subcommand ``compare``: hostkit's filters beside those of other packages."""

from pathlib import Path

import click

from hostkit.cli.compare_output import show
from hostkit.cli.inputs import (
    JSON,
    RECORDINGS,
    REPORT,
    axes_option,
    finite,
    mounting_option,
    read_design,
    read_recording,
    say,
)
from hostkit.cli.output import emit_json
from hostkit.comparison import BUDGET, PEERS, USUAL, CompareOptions, costs, to_document
from hostkit.comparison import compare as run_comparison
from hostkit.errors import HostkitError
from hostkit.mounting import Mounting
from hostkit.records import AxisChoice, FilterDesign

MS_PER_S = 1e3


def parse_peers(context: click.Context, option: click.Parameter, text: str) -> tuple[str, ...]:
    """Read names of peers or packages, separated by commas; ``none`` for none."""
    names = tuple(part.strip() for part in text.split(",") if part.strip())
    known = {name for peer in PEERS for name in (peer.name, peer.package)}
    for name in names:
        if name not in known and names != ("none",):
            raise click.BadParameter(
                f"no peer {name!r}; there are {', '.join(PEERS.names())}, "
                f"and all of a package: {', '.join(sorted({p.package for p in PEERS}))}"
            )
    return () if names == ("none",) else names


def _check_own(design: FilterDesign | None, axes: AxisChoice, mounting: Mounting) -> None:
    """Refuse axes or a mounting beside a design that has others: it would be scored by its own."""
    if design is None:
        return
    pairs = (("axes", axes, design.axes), ("mounting", mounting, design.mounting))
    context = click.get_current_context()
    for name, asked, own in pairs:
        source = context.get_parameter_source(name)
        if source is click.core.ParameterSource.COMMANDLINE and asked != own:
            raise click.UsageError(
                f"--{name} {asked}: the design has {own}, and is compared as it is; leave the "
                "option out, or take another design"
            )


@click.command("compare")
@RECORDINGS
@click.option(
    "--design",
    "design_file",
    type=click.Path(exists=True, dir_okay=False, path_type=Path),
    metavar="FILE",
    help="Compare this design; without one, hostkit's filters by themselves and tuned.",
)
@axes_option("Score one angle, or the inclination; a design brings its own.")
@mounting_option("Body x, y, z as signed sensor axes; a design brings its own.")
@click.option(
    "--peers",
    default=",".join(USUAL),
    show_default=True,
    callback=parse_peers,
    metavar="NAMES",
    help=f"Filters to hold it against, or packages for all of theirs, or none. There are "
    f"{', '.join(PEERS.names())}.",
)
@click.option(
    "--tune/--no-tune",
    "with_tuning",
    default=True,
    show_default=True,
    help="Also tune what is compared, on these recordings, and leave them out in turn.",
)
@click.option(
    "--evaluations",
    type=click.IntRange(40, 1_000_000),
    default=BUDGET,
    show_default=True,
    help="Settings of a fast filter that are tried; slow ones get fewer.",
)
@click.option(
    "--gyro-scale/--no-gyro-scale",
    default=True,
    show_default=True,
    help="Tune the scale of the gyroscope too, for peers as for ours.",
)
@click.option(
    "--lead-ms",
    type=float,
    callback=finite,
    metavar="X",
    help="Tell every filter that can this far ahead; by default what the design says, or none.",
)
@click.option(
    "--calibrated-peers",
    is_flag=True,
    help="Let peers read what the design's calibration makes of the readings.",
)
@click.option(
    "--cost/--no-cost",
    "with_cost",
    default=True,
    show_default=True,
    help="Also build our C and time a sample of each filter.",
)
@click.option("--seed", type=click.IntRange(0, 2**63 - 1), default=1, show_default=True)
@click.option("--jobs", type=click.IntRange(1), default=1, show_default=True)
@REPORT
@JSON
def compare(
    recording_files: tuple[Path, ...],
    design_file: Path | None,
    axes: AxisChoice,
    mounting: Mounting,
    peers: tuple[str, ...],
    with_tuning: bool,
    evaluations: int,
    gyro_scale: bool,
    lead_ms: float | None,
    calibrated_peers: bool,
    with_cost: bool,
    seed: int,
    jobs: int,
    report_file: Path | None,
    as_json: bool,
) -> None:
    """Hold hostkit's filters against VQF, Fusion and others on recordings with a reference.

    Accuracy by default and tuned, tuned filters also on what was left out, and what a sample costs.
    Peers come with: pip install 'hostkit[compare]'.

    \b
    Example:
      hostkit simulate --profile free -o flight.csv
      hostkit compare flight.csv --peers vqf-online,imufusion --report compare.html
    """
    try:
        design = None if design_file is None else read_design(design_file)
        _check_own(design, axes, mounting)
        options = CompareOptions(
            design=design,
            axes=axes,
            mounting=mounting,
            peers=peers,
            tune=with_tuning,
            gyro_scale=gyro_scale,
            lead_s=None if lead_ms is None else lead_ms / MS_PER_S,
            calibrated_peers=calibrated_peers,
            evaluations=evaluations,
            seed=seed,
            jobs=jobs,
        )
    except HostkitError as error:
        raise click.UsageError(str(error)) from error
    recordings = tuple(read_recording(path) for path in recording_files)
    comparison = run_comparison(recordings, options, say)
    found = costs(recordings[0], options) if with_cost else ()
    if as_json:
        emit_json(to_document(comparison, found))
    else:
        show(comparison, found)
    if report_file is not None:
        from hostkit.report.comparison import write_comparison_report

        write_comparison_report(comparison, found, report_file)
