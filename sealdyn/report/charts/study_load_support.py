"""Load support, friction, leakage and clearance of a seal where it rides, over a key."""

import numpy as np

from ...archive import read_study
from .page import absent, look, save, study_page
from .palette import BLACK, BLUE, CONTACT, FILM, GREEN, PURPLE, SKY
from .study_sweep import axis_label, positions, shown

PANELS = {
    "load": ("load_support", 100.0, "load support, % above low pressure", FILM),
    "friction": ("friction_coefficient", 1.0, "friction coefficient", CONTACT),
    "leakage": ("leakage", None, "leakage", BLUE),
    "clearance": ("clearance", 1e6, "clearance, µm", GREEN),
}


@look()
def draw(archive_path, out_path):
    """Four panels over the key: where the seal rides joined, other balances as marks, cavities below the load."""
    study = read_study(archive_path)
    answer = study["answer"]
    (along,) = answer["axes"]
    title = f"How much does the film carry, over {along['key']}?"
    said = " ".join(answer["verdict"][:2])
    if not any(row.get("load_support") is not None for row in answer["rows"]):
        figure, ax = study_page(study, 10.5, 2.6, [["load"]], title, bold=said)
        absent(ax["load"], "Load support", "no balance at any value")
        return save(figure, out_path)
    figure, ax = study_page(study, 10.5, 7.6, [["load", "friction"], ["leakage", "clearance"]], title, bold=said)
    x = positions(along)
    for name, (output, factor, label, colour) in PANELS.items():
        found = [row[output] for row in answer["rows"] if row.get(output) is not None]
        if found and factor is None:
            unit, factor = shown(answer["output_units"][output], np.array(found))
            label = f"{label}, {unit}"
        if found:
            _balances(ax[name], x, answer["rows"], output, factor, colour)
            ax[name].set(ylabel=label, xlabel=axis_label(along), ylim=(0.0, 1.08 * ax[name].get_ylim()[1]))
            if along["unit"] is None:
                ax[name].set_xticks(x, along["values"])
        else:
            absent(ax[name], label, answer["verdict"][-1] if answer["verdict"] else "no value at any point")
    torn = 100.0 * np.array([row.get("cavitated_fraction") for row in answer["rows"]], dtype=float)
    if np.nanmax(torn, initial=0.0) > 0.0:
        ax["load"].fill_between(x, 0.0, torn, color=SKY, alpha=0.35, lw=0, label="of the face cavitates")
        ax["load"].legend(loc="lower left")
    return save(figure, out_path)


def _balances(ax, x, rows, output, factor, colour):
    """An output where the seal rides, and at every other balance."""
    rest = [np.nan if row.get(output) is None else factor * row[output] for row in rows]
    ax.plot(x, rest, "-o", ms=4, lw=1.8, color=colour, label="where it rides")
    for stable, mark, shade in ((True, "o", PURPLE), (False, "x", BLACK)):
        more = [(at, factor * root[output]) for at, row in zip(x, rows, strict=True) for root in row.get("roots", ())
                if root["stable"] == stable and root[output] not in (None, row[output])]  # fmt: skip
        if more:
            label = "another stable balance" if stable else "unstable balance"
            ax.plot(*zip(*more, strict=True), mark, ms=6, color=shade, label=label, ls="none")
            ax.legend(loc="best")
