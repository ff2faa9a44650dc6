"""The verdict of a session as JUnit XML, which continuous integration shows."""

from pathlib import Path
from xml.etree import ElementTree

from hostkit.files import write_aside
from hostkit.monitor.document import monitor_document
from hostkit.monitor.result import SessionResult
from hostkit.report.plain_text import plain_text
from hostkit.validation import Check, checks

CLASS_NAME = "hostkit.monitor"
MOST_REASON = 2000


def write_junit(result: SessionResult, path: Path) -> None:
    """Write the verdict as JUnit XML, aside and then renamed.

    Raises
    ------
    HostkitError
        If the file cannot be written.
    """
    write_aside(path, junit_xml(result))


def junit_xml(result: SessionResult) -> str:
    """Return the verdict as JUnit XML: one suite, a case for the design and one for each check.

    A refused device fails the first case, and the others are skipped.
    """
    cases = _cases(result)
    suite = ElementTree.Element("testsuite", name="hostkit monitor")
    suite.set("time", f"{result.duration_s:.3f}")
    suite.append(_properties(result))
    suite.extend(cases)
    for name, tag in (("failures", "failure"), ("skipped", "skipped")):
        suite.set(name, str(sum(case.find(tag) is not None for case in cases)))
    suite.set("tests", str(len(cases)))
    suite.set("errors", "0")
    if result.device.texts:
        said = "\n".join(plain_text(text) for text in result.device.texts)
        ElementTree.SubElement(suite, "system-out").text = said
    root = ElementTree.Element("testsuites")
    root.append(suite)
    ElementTree.indent(root)
    text: str = ElementTree.tostring(root, encoding="unicode")
    return f'<?xml version="1.0" encoding="UTF-8"?>\n{text}\n'


def _cases(result: SessionResult) -> list[ElementTree.Element]:
    report = result.report
    refused = report.verdict == "refused"
    found = checks(report, result.thresholds)
    cases = [_case("design", "; ".join(report.reasons) if refused else "")]
    cases += [_check_case(check, skipped=refused) for check in found]
    known = {check.reason for check in found}
    others = [reason for reason in report.reasons if not refused and reason not in known]
    return cases + ([_case("session", "; ".join(others))] if others else [])


def _check_case(check: Check, *, skipped: bool) -> ElementTree.Element:
    name = f"{check.name} at most {check.limit}" if check.limit else check.name
    case = _case(name, "" if skipped else check.reason)
    if skipped:
        ElementTree.SubElement(case, "skipped", message="the device was refused")
    else:
        ElementTree.SubElement(case, "system-out").text = plain_text(check.figure)
    return case


def _case(name: str, reason: str) -> ElementTree.Element:
    case = ElementTree.Element("testcase", classname=CLASS_NAME, name=name, time="0")
    if reason:
        message = plain_text(reason, MOST_REASON)
        ElementTree.SubElement(case, "failure", type="verdict", message=message).text = message
    return case


def _properties(result: SessionResult) -> ElementTree.Element:
    """Return the numbers and texts of the document, those of its first level."""
    element = ElementTree.Element("properties")
    values = dict(monitor_document(result))
    values.update(values["session"] if isinstance(values["session"], dict) else {})
    for name, value in values.items():
        if isinstance(value, str | int | float):
            ElementTree.SubElement(element, "property", name=name, value=plain_text(str(value)))
    return element
