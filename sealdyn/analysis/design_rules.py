"""A seal held against design rules (rules/), all of them."""

import difflib
import importlib
import pkgutil
from dataclasses import replace

from ..scene.application import Application
from ..scene.scene import SceneError
from . import rules

GUIDE = "Hayden & Keller, NASA CR-120997 (1974)"


def rule_names() -> list[str]:
    """Names of the rules there are."""
    return sorted(m.name for m in pkgutil.iter_modules(rules.__path__) if m.name[0] != "_")


def refuse_unknown_rules(scenario) -> None:
    """Raises SceneError if the scenario acknowledges a rule that there is not."""
    known = rule_names() if scenario.application else []
    for name in scenario.application.acknowledge if scenario.application else ():
        if name not in known:
            near = difflib.get_close_matches(name, known, 1, 0.0)
            key = "application.acknowledge"
            raise SceneError(
                f"{key}.{name}", "an unknown design rule", f"one of {', '.join(known)}; nearest '{near[0]}'"
            )


def findings(scenario, model) -> list[dict]:
    """What every rule says of a scenario and its `model`, one dict a rule: `rule`, `verdict` ("pass" | "fail" | "note"
    | "acknowledged" | "not applicable"), `value`, `unit`, `least` and `most` (SI, None where there are none), `guide`
    and `source` in it, `said` (a sentence), `command` that tests it ("" if none does), `reason` with which it is
    acknowledged (None without), and the rule's own numbers, `needs` among them: keys of which one is missing.
    Raises SceneError for an unknown rule."""
    # Whoever asks for names alone does not wait for arrays.
    from .rules._seal import Seal

    refuse_unknown_rules(scenario)
    seal = Seal(scenario.scene, scenario.application or Application(), model)
    return [_row(name, seal) for name in rule_names()]


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
