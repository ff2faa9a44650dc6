"""How a sensor is mounted on a body: a signed permutation of its axes."""

import re
from dataclasses import dataclass
from itertools import permutations, product

import numpy as np

from hostkit.errors import DesignError


@dataclass(frozen=True, slots=True, kw_only=True)
class Mounting:
    """A signed axis permutation: which sensor axis, with which sign, is body x, y and z.

    Only the 24 right-handed ones exist; a left-handed one would turn one angle round.
    """

    source: tuple[int, int, int] = (0, 1, 2)
    sign: tuple[int, int, int] = (1, 1, 1)

    def __post_init__(self) -> None:
        """Refuse what is not a rotation."""
        if sorted(self.source) != [0, 1, 2] or any(s not in (1, -1) for s in self.sign):
            raise DesignError(f"mounting {self} names an axis twice or has a sign other than +-1")
        parity = np.linalg.det(np.eye(3)[list(self.source)] * np.asarray(self.sign)[:, None])
        if parity < 0.0:
            raise DesignError(
                f"mounting {self} is left-handed; turn one sign, for example {self._mended()}"
            )

    def _mended(self) -> str:
        x, y, z = self.sign
        return _mounting_text(self.source, (x, y, -z))

    def __str__(self) -> str:
        return _mounting_text(self.source, self.sign)

    @classmethod
    def parse(cls, text: str) -> "Mounting":
        """Read body x, y, z named as signed sensor axes, for example ``+z+x+y``.

        Raises
        ------
        DesignError
            If the text is not three signed axes, or they are not a rotation.
        """
        match = re.fullmatch(r"([+-])([xyz])([+-])([xyz])([+-])([xyz])", text)
        if match is None:
            raise DesignError(
                f"mounting {text!r} is not three signed sensor axes, one each for body x, y and z, "
                "such as +x+y+z or +z+x+y"
            )
        signs, axes = match.groups()[0::2], match.groups()[1::2]
        x, y, z = ("xyz".index(axis) for axis in axes)
        sx, sy, sz = (1 if sign == "+" else -1 for sign in signs)
        return cls(source=(x, y, z), sign=(sx, sy, sz))

    @classmethod
    def all(cls) -> tuple["Mounting", ...]:
        """Return the 24 mountings."""
        found = []
        for source in permutations((0, 1, 2), 3):
            for x, y, z in product((1, -1), repeat=3):
                try:
                    found.append(cls(source=source, sign=(x, y, z)))
                except DesignError:
                    continue
        return tuple(found)


def _mounting_text(source: tuple[int, int, int], sign: tuple[int, int, int]) -> str:
    return "".join(
        f"{'+' if s > 0 else '-'}{'xyz'[axis]}" for axis, s in zip(source, sign, strict=True)
    )
