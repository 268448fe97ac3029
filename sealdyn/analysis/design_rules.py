"""A seal held against design rules (rules/), all of them."""

import importlib
from dataclasses import replace

from ..scenario.rule_names import rule_names
from ..scene.application import Application
from . import rules

GUIDE = "Hayden & Keller, NASA CR-120997 (1974)"


def findings(scenario, model) -> list[dict]:
    """What every rule says of a scenario and its `model`, one dict a rule: `rule`, `verdict` ("pass" | "fail" | "note"
    | "acknowledged" | "not applicable"), `value`, `unit`, `least` and `most` (SI, None where there are none), `guide`
    and `source` in it, `said` (a sentence), `command` that tests it ("" if none does), `reason` with which it is
    acknowledged (None without), and the rule's own numbers, `needs` among them: keys of which one is missing.
    Raises SceneError where the film has no solution."""
    # Whoever asks for names alone does not wait for arrays.
    from ..simulation.result import plain
    from .rules._seal import Seal

    seal = Seal(scenario.scene, scenario.application or Application(), model)
    return [plain(_row(name, seal)) for name in rule_names()]


def _row(name: str, seal) -> dict:
    rule = importlib.import_module(f"{rules.__name__}.{name}")
    reason = seal.application.acknowledge.get(name)
    found = acknowledged(rule.finding(seal), reason)
    return {
        "rule": name,
        "verdict": str(found.verdict),
        "value": found.value,
        "unit": found.unit,
        "least": found.least,
        "most": found.most,
        "guide": GUIDE,
        "source": rule.SOURCE,
        "said": found.said,
        "command": rule.COMMAND,
        "reason": reason,
        **found.numbers,
    }


def acknowledged(found, reason: str | None):
    """A rule's finding, acknowledged where the rule is broken and a `reason` is given."""
    from .rules._finding import Verdict

    broken = found.verdict in (Verdict.FAIL, Verdict.NOTE)
    return replace(found, verdict=Verdict.ACKNOWLEDGED) if reason is not None and broken else found
