"""The options of the firmware on the command line; some of them an FPGA has, too."""

from typing import get_args

import click

from hostkit.cli.chosen import option as _option
from hostkit.render.options import STREAMED_MESSAGES, Acquisition, Arithmetic, Profile

FIRMWARE_OPTIONS = (
    _option(
        "--profile",
        type=click.Choice(get_args(Profile)),
        help="Who the device says it is: a vehicle that ground stations show (gcs, the default), "
        "or a component on board of one.",
    ),
    _option("--system-id", type=int, metavar="N", help="MAVLink system id; 1 by default."),
    _option("--baud", type=int, metavar="N", help="Rate of the link, bit/s."),
    _option(
        "--message",
        "message_rates",
        multiple=True,
        metavar="NAME=HZ",
        help="How often a message goes out, 0 is never; may be repeated. Names: "
        + ", ".join(STREAMED_MESSAGES)
        + ".",
    ),
    _option(
        "--arithmetic",
        type=click.Choice(get_args(Arithmetic)),
        help="Compute in integers that equal the model bit for bit (fixed, the default), or in "
        "float.",
    ),
    _option(
        "--acquisition",
        type=click.Choice(get_args(Acquisition)),
        help="Read sample by sample (burst, the default), or out of the sensor's FIFO.",
    ),
    _option(
        "--calibrate-at-start",
        is_flag=True,
        help="Measure the gyroscope's bias after each start, at rest.",
    ),
    _option("--signing", is_flag=True, help="Sign the messages."),
)
