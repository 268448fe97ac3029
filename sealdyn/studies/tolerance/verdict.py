"""The answer in words: the verdict's sentences and the tables below it."""

from ...status import Status
from .._words import shown_in

# Share of its median that the spread of an output has at least, for a tolerance to matter to it.
LITTLE = 1e-3
# By how much an estimated first index may be above the total, before it says that neither is settled.
ROUGHLY = 0.05


def sentences(answer, rows) -> list[str]:
    """The verdict: how many touch, which tolerance first, what failed."""
    name = answer["outputs"][0]
    lines = [_contact_sentence(answer), _tighten_sentence(answer, name)]
    bad = [row for row in rows if row.get("status", Status.FAILED) == Status.FAILED]
    if bad:
        first = bad[0].get("failed") or bad[0].get("message")
        lines.append(f"{len(bad)} of {len(rows)} runs gave no numbers and widen the interval; the first: {first}")
    return lines


def _contact_sentence(answer) -> str:
    risk, unstable = answer["probability_of_contact"], answer["runs"]["unstable"]
    if risk["value"] is None:
        return f"No run ended, so whether the faces touch is not known ({counted_ends(answer)})."
    share = f"{100 * risk['value']:.3g} %" if risk["count"] else "None"
    words = (f"{share} of the seals touch ({risk['count']} of {risk['runs']} runs; 95 % interval "
             f"{100 * risk['low']:.3g} to {100 * risk['high']:.3g} %)")  # fmt: skip
    if answer["runs"]["asked"] > answer["runs"]["distribution"]:
        others = answer["runs"]["asked"] - answer["runs"]["distribution"]
        words += f"; the other {others} runs repeat these with one key changed, for the indices"
    closed = answer["runs"]["closed_at_start"]
    # The linear steady state that a run may begin with touches before the film, which lifts the faces, would.
    words += f"; {closed} of them before anything moves (contact-onset follows the film further)" if closed else ""
    return f"{words}; {unstable} are unstable and may touch later." if unstable else f"{words}."


def _tighten_sentence(answer, name) -> str:
    spread, unit = answer["quantiles"][name], answer["output_units"][name]
    if spread["5"] is None:
        return f"{name} has no value in any run."
    count, runs = answer["moments"][name]["count"], answer["runs"]["distribution"]
    wide = spread["95"] - spread["5"]
    if wide <= LITTLE * abs(spread["50"]) and wide > 0.0:
        shown, factor = shown_in(unit, [spread["50"]])
        middle, share = f"{factor * spread['50']:.4g} {shown}".strip(), 100.0 * wide / abs(spread["50"])
        return (f"{name} hardly scatters: {middle} within {share:.1g} % in nine seals of ten, no tolerance need be "
                "tightened for it; --outputs asks of another first.")  # fmt: skip
    shown, factor = shown_in(unit, spread.values())
    begin = f"{name} is {factor * spread['5']:.4g} to {factor * spread['95']:.4g} {shown}".strip()
    begin += " in nine seals of ten"
    begin += f" of the {count} of {runs} that have one" if count < runs else ""
    first, *others = answer["tighten"][name]
    if first["total"] is None:
        strongest = first["rank_correlation"]
        if strongest is None:
            return f"{begin}: nothing that scatters changes it."
        why = answer["sobol"]["reason"] or f"only {answer['sobol']['base_points'][name]} samples have all their runs"
        return (f"{begin}; it follows {first['key']} most closely, with a rank correlation of {strongest:.2f} "
                f"({why}: no indices).")  # fmt: skip
    rivals = [row["key"] for row in others if row["total_high"] > first["total_low"]]
    halved, removed = (f"{100 * first[name]:.0f} %" for name in ("halved", "removed"))
    words = (f"{begin}; tighten {first['key']} first: its total index is {first['total']:.2f} "
             f"({first['total_low']:.2f} to {first['total_high']:.2f}), half its scatter would leave {halved} of the "
             f"standard deviation, none {removed}")  # fmt: skip
    more = f"; {listed(rivals)} may matter as much: more samples tell" if rivals else ""
    unsettled = [row["key"] for row in (first, *others) if row["first"] - row["total"] > ROUGHLY]
    if unsettled:
        more += (f"; a first index cannot be above the total, as that of {listed(unsettled)} is here: so few samples "
                 "give indices to some tenths only")  # fmt: skip
    return f"{words}{more}."


def listed(words: list[str]) -> str:
    """ "a, b and c"."""
    return " and ".join(filter(None, (", ".join(words[:-1]), words[-1])))


def _spread(answer, name) -> dict:
    """The distribution of an output, in the unit in which it is shown."""
    levels, moments = answer["quantiles"][name], answer["moments"][name]
    unit, factor = shown_in(answer["output_units"][name], levels.values())
    numbers = {"nominal": answer["nominal"][name], "mean": moments["mean"]}
    numbers |= {"standard_deviation": moments["standard_deviation"]} | {f"q{p}": v for p, v in levels.items()}
    shown = {key: None if value is None else factor * value for key, value in numbers.items()}
    return {"output": name, **shown, "count": moments["count"], "unit": unit}


def counted_ends(answer) -> str:
    return ", ".join(f"{count} {word}" for word, count in answer["runs"]["ends"].items())


def tables(answer) -> list:
    """The distribution of every output; the keys, as the first output has them; total indices of all outputs."""
    outputs, first = answer["outputs"], answer["outputs"][0]
    spreads = [_spread(answer, name) for name in outputs]
    columns = (("output", "output"), ("nominal", "nominal"), ("mean", "mean"), ("st. dev.", "standard_deviation"),
               *((f"{p} %", f"q{p}") for p in answer["quantiles"][first]), ("unit", "unit"),
               ("values", "count"))  # fmt: skip
    shown = (("key", "key"), ("scatter", "scatter"), ("first", "first"), ("total", "total"), ("from", "total_low"),
             ("to", "total_high"), ("rank corr.", "rank_correlation"), ("sd if halved, %", "halved", 100),
             ("if none, %", "removed", 100), ("contact if halved, %", "contact_halved", 100))  # fmt: skip
    found = [(spreads, columns), (answer["tighten"][first], shown)]
    total = answer["sobol"]["total"]
    if total and len(outputs) > 1 and any(total.values()):
        keys = [row["key"] for row in answer["tighten"][first]]
        rows = [{"key": key, **{f"o{n}": total[name] and total[name][key] for n, name in enumerate(outputs)}}
                for key in keys]  # fmt: skip
        found.append((rows, (("total index", "key"), *((name, f"o{n}") for n, name in enumerate(outputs)))))
    return found
