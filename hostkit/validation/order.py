"""Putting samples in order by the device's own counter, and counting those that never came."""

import math
from collections import OrderedDict
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

COUNTER = 2**32
WINDOW = 1024
"""How far behind the newest a sample may come and still be late, not a counter that began anew."""

HEAD = 8
"""How far before the first sample that was heard one may be and still be late."""

SURE_STEPS = 8
"""Equal steps that make a habit: from then on only every so many-th sample is expected."""

Place = Literal["follows", "gap", "anew", "late", "repeated"]


@dataclass(slots=True)
class _Stretch:
    """Steps of the counter while the device sends every so many-th sample."""

    advance: int = 0
    steps: int = 0
    divisor: int = 0

    def add(self, step: int, times: int = 1) -> None:
        self.advance += step * times
        self.steps += times
        self.divisor = math.gcd(self.divisor, step)

    @property
    def stride(self) -> int:
        """Every how many-th sample is sent."""
        return self.divisor if self.steps >= SURE_STEPS else 1

    @property
    def missing(self) -> int:
        """Samples between those that came which were to come too."""
        return self.advance // self.stride - self.steps


class SampleOrder:
    """An account of the sample counter, in bounded memory.

    The stride is the greatest common divisor of the steps, so that losses of a stream that is
    thinned out on purpose are still told from what was never to be sent.

    Attributes
    ----------
    late, repeated
        Samples that came behind a later one, and samples that came again.
    restarts
        How often the counter began anew without being told to.
    widest_stride
        The greatest stride so far.
    thinned
        Samples that came while the stride was above one.
    """

    def __init__(self) -> None:
        self._last: int | None = None
        self._first = self.restarts = 0
        self._recent: OrderedDict[int, bytes] = OrderedDict()
        self.forget_figures()

    def forget_figures(self) -> None:
        """Count anew; the order goes on."""
        self.late = self.repeated = self._found = self._missing = self._thinned = 0
        self._widest = 1
        self._stretch = _Stretch()
        self._same, self._step = 0, 0

    def begin(self) -> None:
        """Take the next sample as the first of a counter that is not known."""
        self._last = None
        self._recent.clear()
        self._close_stretch()

    @property
    def lost(self) -> int:
        """Samples that never came."""
        return max(0, self._missing + self._stretch.missing - self._found)

    @property
    def widest_stride(self) -> int:
        """Return the greatest stride so far."""
        return max(self._widest, self._stretch.stride)

    @property
    def thinned(self) -> int:
        """Return how many samples came while the stride was above one."""
        return self._thinned + (self._stretch.steps if self._stretch.stride > 1 else 0)

    def place(self, number: int, content: bytes, *, restarted: bool) -> tuple[Place, int]:
        """Take one sample.

        Parameters
        ----------
        number, content
            Its counter, and bytes that are the same only if it is the same sample.
        restarted
            Whether the filter started with it.

        Returns
        -------
        place, step
            Where it stands, and how many samples it is ahead of the one before; 1 where the
            counter began anew, 0 where it is to be left out.
        """
        if self._last is None:
            return self._begin_with(number, content)
        step = (number - self._last) % COUNTER
        if 0 < step < COUNTER // 2 and not (restarted and number < HEAD and step > 1):
            self._advance(step)
            self._remember(number, content)
            return ("follows" if step == 1 else "gap"), step
        if number in self._recent:
            if self._recent[number] == content:
                self.repeated += 1
                return "repeated", 0
            return self._begin_with(number, content)
        return self._behind(number, content, restarted=restarted)

    def _behind(self, number: int, content: bytes, *, restarted: bool) -> tuple[Place, int]:
        assert self._last is not None
        behind = (self._last - number) % COUNTER
        before_first = (self._first - number) % COUNTER
        if before_first < COUNTER // 2:
            is_late = before_first <= (3 if restarted else HEAD) and behind <= WINDOW
        else:
            is_late = behind <= WINDOW
            self._found += int(is_late)
        if not is_late:
            return self._begin_with(number, content)
        self.late += 1
        self._remember(number, content)
        return "late", 0

    def _begin_with(self, number: int, content: bytes) -> tuple[Place, int]:
        self.restarts += int(self._last is not None)
        self.begin()
        self._first = self._last = number
        self._recent[number] = content
        return "anew", 1

    def _remember(self, number: int, content: bytes) -> None:
        self._recent[number] = content
        if len(self._recent) > WINDOW:
            self._recent.popitem(last=False)

    def _advance(self, step: int) -> None:
        """Count a step; begin another stretch where the stride changes."""
        assert self._last is not None
        self._last = (self._last + step) % COUNTER
        self._same = self._same + 1 if step == self._step else 1
        self._step = step
        now = self._stretch
        if now.stride > 1 and step % now.stride:
            self._close_stretch()
        elif (
            step > 1 and self._same == SURE_STEPS and now.steps >= SURE_STEPS and step > now.stride
        ):
            now.advance -= step * (SURE_STEPS - 1)
            now.steps -= SURE_STEPS - 1
            self._close_stretch()
            self._stretch.add(step, SURE_STEPS - 1)
        self._stretch.add(step)

    def _close_stretch(self) -> None:
        self._widest, self._thinned = self.widest_stride, self.thinned
        self._missing += self._stretch.missing
        self._stretch = _Stretch()


def places(
    order: SampleOrder, numbers: Sequence[int], contents: Sequence[bytes], restarted: Sequence[bool]
) -> list[tuple[Place, int]]:
    """Return what :meth:`SampleOrder.place` says of each of some samples."""
    return [
        order.place(number, content, restarted=begins)
        for number, content, begins in zip(numbers, contents, restarted, strict=True)
    ]
