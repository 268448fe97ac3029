"""Words for people: the summary of a run, a resolved scene, what an archive holds."""

import math

from ..status import Status
from ..toml_line import toml_line

MICRO, MILLI = 1e6, 1e3


def lines(scenario, summary: dict) -> list[str]:
    """About a dozen lines: what a seal engineer reads first."""
    model, stability, film, closing = (summary[k] for k in ("model", "stability", "film", "closing"))
    out = [
        f"{scenario.name}: {summary['status']}" + ("" if summary["status"] == Status.OK else f" - {summary['message']}")
    ]
    out.append(
        f"  model         {model['film']} film, unknowns {', '.join(model['unknowns'])}; {model['solver']}, "
        f"{summary['counts']['steps']} steps, {summary['counts']['rhs']} evaluations, {summary['wall_time']:.2g} s"
    )
    out += [f"                {reason}" for reason in model["reasons"]]
    if model["unused"]:
        out.append(f"  not used      {', '.join(model['unused'])}")
    low = summary["h_min"]
    if low["value"] is not None:
        out.append(
            f"  h_min         {_n(low['value'], MICRO)} um ({_n(low['of_clearance'], 100)} % of the clearance) at "
            f"t = {_n(low['time'])} s, theta = {_n(low['theta'], 180 / math.pi)} deg, r = {_n(low['radius'], MILLI)} mm"
        )
    out += _tilt_lines(summary)
    leak, friction = summary["leakage"], summary["friction"]
    out.append(
        f"  leakage       {_n(leak['mean'])} m^3/s = {_n(leak['mean_ml_per_h'])} ml/h = "
        f"{_n(leak['mean_kg_per_h'])} kg/h (mean)"
    )
    out.append(
        f"  friction      {_n(friction['power'])} W, torque {_n(friction['torque'])} N m; "
        f"would heat the leakage by {_n(friction['temperature_rise'])} K"
    )
    out.append(
        f"  film          clearance {_n(film['clearance'], MICRO)} um, tilt stiffness {_n(film['tilt_stiffness'])} "
        f"N m/rad, tilt damping {_n(film['tilt_damping'])} N m s/rad, axial stiffness {_n(film['axial_stiffness'])} N/m"
    )
    out.append(
        f"  closing       {_n(closing['force'])} N (balance ratio {_n(closing['balance_ratio'])}, spring "
        f"{_n(closing['spring_force'])} N, duty {_n(closing['duty'], 1e-5)} bar)"
    )
    out += _contact_lines(summary["contact"]) + _seal_lines(summary["secondary_seal"])
    if film["max_cavitated_fraction"]:
        out.append(
            f"  cavitation    up to {_n(film['max_cavitated_fraction'], 100)} % of the face at the floor pressure "
            "(floored after solving: does not conserve mass)"
        )
    out.append(_stability_line(stability))
    if summary["energy_residual"] is not None:
        bound = 10 * summary["accuracy"]
        warn = "" if summary["energy_residual"] < bound else f"  ABOVE {bound:.0e}: do not trust this run"
        out.append(f"  energy audit  residual {summary['energy_residual']:.1e} of the work exchanged{warn}")
    if summary.get("certificate"):
        out.append(f"  accuracy      {summary['certificate']['said']}")
    out += [f"  WARNING       {warning}" for warning in summary["warnings"]]
    files = [summary["archive"]] + ([summary["figure"]] if summary.get("figure") else [])
    out.append(f"  files         {', '.join(files)}")
    return out


def _contact_lines(contact):
    if contact is None:
        return []
    grazing = f"; {contact['grazing']} grazing within {_n(contact['gap_error'], MICRO)} um, undecided"
    grazing = grazing if contact["grazing"] else ""
    if not contact["touches"]:
        return [f"  touch         never (asperities meet at {_n(contact['touch_at'], MICRO)} um){grazing}"]
    return [
        f"  touch         {contact['touches']} contacts, first at t = {_n(contact['first'])} s, deepest "
        f"{_n(contact['depth'], MICRO)} um, longest {_n(contact['longest'])} s, impulse {_n(contact['impulse'])} N s"
        + grazing,
        f"                carries {_n(contact['share_of_closing'], 100)} % of the closing force, up to "
        f"{_n(contact['force']['max'])} N and {_n(contact['max_pressure'], 1e-6)} MPa on "
        f"{_n(contact['max_area_fraction'], 100)} % of the face; wear {_n(contact['wear_rate'], 3.6e9)} um/h",
    ]


def _seal_lines(seals):
    if seals is None:
        return []
    out = [
        f"  o-ring        {name}: {seal['law']} friction, breaks away at {_n(seal['breakaway_force'])} N or "
        f"{_n(seal['breakaway_moment'])} N m"
        for name, seal in seals["rings"].items()
    ]
    if seals["sticks"] is not None:
        held = ", ".join(seals["stuck_at_end"])
        out.append(
            f"                stuck {seals['sticks']} times, slipped {seals['slips']} times"
            + (f"; at the end stuck: {held}" if held else "; at the end sliding")
        )
    return out


def _tilt_lines(summary):
    tilt, form = summary["relative_misalignment"], summary["closed_form"]
    out = []
    if tilt["max"] is not None:
        out.append(
            f"  misalignment  relative, urad: max {_n(tilt['max'], MICRO)}, min {_n(tilt['min'], MICRO)}, "
            f"mean {_n(tilt['mean'], MICRO)}"
        )
    if tilt["steady_max"] is not None:
        out.append(
            f"  steady state  urad: max {_n(tilt['steady_max'], MICRO, 6)}, min {_n(tilt['steady_min'], MICRO, 6)}"
            + (
                f"; closed form {_n(form['relative_max'], MICRO, 6)}, {_n(form['relative_min'], MICRO, 6)} "
                f"({form['road']})"
                if "relative_max" in form
                else ""
            )
        )
    else:
        out.append(f"  steady state  {tilt['steady_said']}")
    margin = summary["contact_margin"]
    if margin is not None:
        out.append(f"  contact       linear theory: forcing may grow {_n(margin)} times before the faces touch")
    return out


def _stability_line(stability):
    critical = stability["critical_speed"]
    whirl = stability["whirl_ratio"]
    text = f"  stability     {stability['verdict']} (all degrees of freedom, at {_n(stability['speed'])} rad/s)"
    if whirl is not None:
        text += f", whirl ratio {_n(whirl)}"
    if critical:
        # Which side is the stable one follows from the verdict at this speed.
        below = (stability["verdict"] == "stable") == (abs(stability["speed"]) < critical)
        text += f", critical speed {_n(critical)} rad/s (stable {'below' if below else 'above'})"
    else:
        text += ", no critical speed"
    if stability["resonance_speeds"]:
        text += ", resonance at " + ", ".join(_n(w) for w in stability["resonance_speeds"]) + " rad/s"
    return text


def _n(value, factor=1.0, digits=4):
    return "-" if value is None else f"{value * factor:.{digits}g}"


def resolved_lines(found: dict) -> list[str]:
    """The resolved scene in SI, then what the program makes of it."""
    out = []
    for table, keys in found["scene"].items():
        out += _table_lines(table, keys)
    model = found["model"]
    out.append(f"# {model['film']} film; unknowns {', '.join(model['unknowns'])}; solver {model['solver']}")
    out += [f"# {reason}" for reason in model["reasons"]]
    for root in found["equilibria"]:
        kind = "stable" if root["stable"] else "not stable by the film alone"
        where = f"{_n(root['clearance'], MICRO)} um, film stiffness {_n(root['stiffness'])} N/m"
        out.append(f"# equilibrium clearance {where}, {kind}")
    out += [f"# {'ok' if rule['holds'] else 'WARNING'}: {rule['said']}" for rule in found["design_rules"]]
    if model["unused"]:
        out.append(f"# not used: {', '.join(model['unused'])}")
    return out


def _table_lines(name, value):
    if not isinstance(value, dict):
        return [] if value is None or value == [] else [f"{name} = {toml_line(value)}"]
    plain = {k: v for k, v in value.items() if not isinstance(v, dict) or set(v) == {"time", "value"}}
    out = [f"[{name}]"] if any(v is not None and v != [] for v in plain.values()) else []
    out += [f"{k} = {toml_line(v)}" for k, v in plain.items() if v is not None and v != []]
    for k, v in value.items():
        if k not in plain:
            out += _table_lines(f"{name}.{k}", v)
    return out


def archive_lines(path, info: dict) -> list[str]:
    """What an archive holds."""
    out = [
        f"{path}: {info['status']}" + (f" - {info['message']}" if info.get("message") else ""),
        f"  made          {info['created']} by sealdyn {info.get('version', '?')}, solver {info.get('solver', '?')}, "
        f"accuracy {info.get('accuracy', '?')}",
        f"  rows          {info['rows']}",
    ]
    restart = info.get("restart") or {}
    if info["status"] == Status.RUNNING and restart:
        out.append(f"  state kept    leg {restart.get('leg')}, leg time {restart.get('tau')} s")
    summary = info.get("summary") or {}
    if summary:
        low = summary["h_min"]
        out.append(f"  h_min         {_n(low['value'], MICRO)} um at t = {_n(low['time'])} s")
        out.append(_stability_line(summary["stability"]))
    for event in info.get("events", []):
        out.append(f"  event         {event['kind']} at t = {_n(event['time'])} s")
    out.append("  series        " + ", ".join(f"{n} [{s.units}]" for n, s in info["series"].items()))
    if info["fields"]:
        over = " x ".join(f"{count} {name}" for name, count in info["grid"].items())
        out.append("  fields        " + ", ".join(f"{n} [{s.units}]" for n, s in info["fields"].items()) + f": {over}")
    return out


def csv_rows(info: dict, column, block: int = 4096):
    """Header and rows of all series, read block by block."""
    names = ["time", *[n for n in info["series"] if n != "time"]]
    yield ",".join(f"{n} [{info['series'][n].units}]" for n in names)
    for start in range(0, info["rows"], block):
        part = [column(name, slice(start, min(start + block, info["rows"]))) for name in names]
        for row in zip(*part, strict=True):
            yield ",".join(repr(float(x)) for x in row)
