"""What ``params`` prints: tables for people, documents for programs."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import click

from hostkit.filters.filter import ParameterView
from hostkit.link.device.device_link import DeviceLink, SettingOutcome
from hostkit.link.device.parameter_entry import ParameterEntry
from hostkit.link.device.parameter_facts import ParameterFacts
from hostkit.link.device.parameter_file import number_text

SCHEMA = "hostkit.params/1"


@dataclass(frozen=True, slots=True, kw_only=True)
class Shown:
    """What is known while parameters are shown.

    Attributes
    ----------
    rate_hz
        Sample rate, of the design or as the device's samples have it; None if neither is known.
    measured
        Whether the rate is the device's, and so not exact.
    """

    facts: Mapping[str, ParameterFacts]
    rate_hz: float | None
    measured: bool

    @classmethod
    def of(
        cls, facts: Mapping[str, ParameterFacts], link: DeviceLink, rate_hz: float | None
    ) -> "Shown":
        """Take the rate of the design, or else the device's."""
        measured = rate_hz is None
        return cls(facts=facts, rate_hz=link.rate_hz if measured else rate_hz, measured=measured)

    def views(self, name: str) -> tuple[ParameterView, ...]:
        """Return what says the same as a parameter; nothing where no rate is known."""
        fact = self.facts.get(name)
        return fact.views(1.0 / self.rate_hz) if fact is not None and self.rate_hz else ()

    def viewed_by_name(self, name: str, value: float) -> dict[str, float | None]:
        """Return what says the same as a value by its key; null where no rate is known."""
        fact = self.facts.get(name)
        names = () if fact is None else tuple(view.name for view in fact.views(1.0))
        found = {view.name: view.of(value) for view in self.views(name)}
        return {key: found.get(key) for key in names}

    def viewed(self, name: str, value: float, *, about: str = "") -> str:
        """Return the first view of a value in words; empty where there is none."""
        for view in self.views(name)[:1]:
            shown = view.of(value)
            if shown is not None:
                return f"{view.name} {about}{shown:.6g} {view.unit}".rstrip()
        return ""

    def text(self, name: str, value: float) -> str:
        """Return a value with its unit."""
        fact = self.facts.get(name)
        unit = f" {fact.unit}" if fact is not None and fact.unit else ""
        return f"{number_text(value)}{unit}"

    def remarks(self, entry: ParameterEntry) -> str:
        """Return what else is to be said of a value."""
        said = []
        about = "about " if self.measured else ""
        viewed = self.viewed(entry.name, entry.value, about=about)
        if viewed:
            said.append(f"{viewed} at {about}{self.rate_hz:.5g} Hz")
        fact = self.facts.get(entry.name)
        if fact is not None and fact.design_value not in (None, entry.value):
            said.append(f"design {self.text(entry.name, fact.design_value or 0.0)}")
        if entry.error:
            said.append(entry.error)
        return "; ".join(said)

    def row(self, entry: ParameterEntry) -> dict[str, object]:
        """Return an entry as a part of the document."""
        fact = self.facts.get(entry.name)
        return {
            "name": entry.name,
            "value": entry.value,
            "unit": "" if fact is None else fact.unit,
            "lowest": None if fact is None else fact.lowest,
            "highest": None if fact is None else fact.highest,
            "design_value": None if fact is None else fact.design_value,
            **self.viewed_by_name(entry.name, entry.value),
        }


def show_entries(entries: Iterable[ParameterEntry], shown: Shown) -> None:
    """Print a table of parameters."""
    rows = [(e.name, shown.text(e.name, e.value), shown.remarks(e)) for e in entries]
    width = max((len(value) for _, value, _ in rows), default=0)
    for name, value, remarks in rows:
        click.echo(f"{name:<16}  {value:<{width}}  {remarks}".rstrip())


def show_outcomes(outcomes: Sequence[SettingOutcome], shown: Shown) -> None:
    """Print what became of values that were set."""
    for outcome in outcomes:
        asked = shown.text(outcome.name, outcome.asked)
        if outcome.error:
            click.echo(f"{outcome.name} {asked} -> not set: {outcome.error}")
        elif outcome.in_use is not None:
            viewed = shown.viewed(outcome.name, outcome.in_use)
            beside = f" ({viewed})" if viewed else ""
            in_use = shown.text(outcome.name, outcome.in_use)
            click.echo(f"{outcome.name} {asked} -> in use {in_use}{beside}")


def document(action: str, link: DeviceLink, **parts: object) -> dict[str, object]:
    """Return the document ``hostkit.params/1`` with the parts of its action."""
    system, component = link.parameters.target or (None, None)
    head = {"schema": SCHEMA, "action": action, "system": system, "component": component}
    return {**head, "digest": link.digest, **parts}


def outcome_rows(outcomes: Iterable[SettingOutcome]) -> list[dict[str, object]]:
    """Return what became of values as a part of the document."""
    return [
        {
            "name": outcome.name,
            "asked": outcome.asked,
            "in_use": outcome.in_use,
            "error": outcome.error or None,
        }
        for outcome in outcomes
    ]
