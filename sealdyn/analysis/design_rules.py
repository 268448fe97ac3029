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
    from ..simulation.summary import plain
    from .rules._seal import Seal

    seal = Seal(scenario.scene, scenario.application or Application(), model)
    return [plain(_row(name, seal)) for name in rule_names()]


def _row(name: str, seal) -> dict:
    from .rules._finding import Verdict

    rule = importlib.import_module(f"{rules.__name__}.{name}")
    found, reason = rule.finding(seal), seal.application.acknowledge.get(name)
    if reason is not None and found.verdict in (Verdict.FAIL, Verdict.NOTE):
        found = replace(found, verdict=Verdict.ACKNOWLEDGED)
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
