"""Campbell diagram: whirl frequencies and logarithmic decrements over shaft speed."""

import re

import numpy as np

from ...archive import read_study
from .page import PAPER, look, number, once, save, study_page
from .palette import BLACK, CYCLE, GREY, VERMILLION

# Dashes of a direction of whirl, and its name.
DASHES = {"forward": ("-", "forward"), "backward": ((0, (5, 2)), "backward"), "axial": ((0, (1, 1.2)), "axial"),
          "none": ((0, (1, 4)), "does not oscillate")}  # fmt: skip
RPM = 60 / (2 * np.pi)
# Of marks on the axis of decrements the least, where all are small.
TICKS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 3, 10, 30, 100, 300, 1000)
# Beyond this a curve runs along the top: the mode hardly oscillates.
MOST_DECREMENT = 1000.0
# Share of the panel from which the unstable side has room for its name.
NAMED = 0.06
# Width of a curve, and what it has more for each later one that lies on it, so that both are seen: closer than NEAR of
# the panel over more than PART of the speeds.
LINE, WIDER, NEAR, PART = 1.8, 2.4, 0.005, 0.25
# A line of the verdict that describes a mode.
ONE_MODE = re.compile(r"Mode \d+ \(")


@look()
def draw(archive_path, out_path):
    """Frequencies on the left, decrements on the right, from a study's archive."""
    study = read_study(archive_path)
    answer, title = study["answer"], "At which frequencies does the seal whirl?"
    # What each mode is, the curves show.
    found = " ".join(line for line in answer["verdict"] if not ONE_MODE.match(line))
    figure, ax = study_page(study, 11.5, 6.6, [["frequency", "decrement"]], title, bold=found, width_ratios=(3, 2))
    factor = RPM if answer["unit"] == "rpm" else 1.0
    speed = factor * np.array(answer["speed"])
    _frequencies(ax["frequency"], answer, speed, factor)
    _decrements(ax["decrement"], answer, speed, factor)
    for panel in ax.values():
        panel.set(xlim=(speed[0], speed[-1]), xlabel=f"shaft speed, {answer['unit']}")
        panel.locator_params(axis="x", nbins=6)
    entries = len(ax["frequency"].get_legend_handles_labels()[0])
    if entries:
        columns = entries if entries <= 7 else -(-entries // 2)
        figure.legend(loc="outside lower left", ncols=columns, borderaxespad=1.5)
    return save(figure, out_path)


def _frequencies(ax, answer, speed, factor):
    modes = answer["modes"]
    curves = [factor * np.array(m["frequency"]) for m in modes]
    top = min(1.08 * max((values.max() for values in curves), default=1.0), 1.25 * speed[-1])
    # What oscillates at no speed would lie on the axis.
    moving = [k for k, values in enumerate(curves) if values.any()]
    for k, width in zip(moving, widths([curves[k] for k in moving], top), strict=True):
        ax.plot([], [], color=CYCLE[k % len(CYCLE)], lw=width, label=f"mode {k + 1}, {modes[k]['kind']}")
        _by_direction(ax, speed, curves[k], modes[k]["directions"], k, width)
    seen = {direction for k in moving for direction in modes[k]["directions"]}
    for dashes, label in (DASHES[name] for name in DASHES if name in seen):
        ax.plot([], [], color=GREY, lw=LINE, ls=dashes, label=label)
    unit = "cycles per minute" if answer["unit"] == "rpm" else "rad/s"
    still = [k + 1 for k in range(len(modes)) if k not in moving]
    title = "Whirl frequency" + (f" ({_modes(still)} do{'es' * (len(still) == 1)} not oscillate)" if still else "")
    ax.set(ylim=(0, top), ylabel=f"whirl frequency, {unit}", title=title)
    hidden = [k + 1 for k, values in enumerate(curves) if values.min() > top]
    if hidden:
        words = f"above: {_modes(hidden)}"
        ax.text(0.02, 0.98, words, transform=ax.transAxes, va="top", fontsize=8, color=GREY, bbox=PAPER, zorder=5)
    named = [factor * np.array([c["speed"], c["frequency"]]) for c in answer["crossings"]]
    for order in answer["lines"]:
        ax.plot(speed, order * speed, color=GREY, lw=0.9)
        _name_line(ax, order, speed, top, curves, named, [k for k in answer["lines"] if k != order])
    for c in answer["crossings"]:
        ax.plot(factor * c["speed"], factor * c["frequency"], "o", mfc="white", mec=BLACK, ms=6, zorder=4,
                label=once(ax, "meets an order line"))  # fmt: skip
    # Archives of earlier versions do not hold it.
    turning = factor * abs(answer.get("stator_speed") or 0.0)
    if 0.0 < turning < top:
        ax.axhline(turning, color=GREY, lw=0.9, ls=(0, (6, 2, 1, 2)), label="stator's own speed")
        for c in answer["stator_crossings"]:
            ax.plot(factor * c["speed"], turning, "s", mfc="white", mec=BLACK, ms=6, zorder=4,
                    label=once(ax, "meets it"))  # fmt: skip
    if speed[0] < factor * answer["own_speed"] < speed[-1]:
        ax.axvline(factor * answer["own_speed"], color=GREY, lw=0.8, ls=":", label="this scenario")


def _modes(numbers: list[int]) -> str:
    return f"mode{'s' * (len(numbers) > 1)} {', '.join(map(str, numbers))}"


def _name_line(ax, order, speed, top, curves, points, others):
    """The order's name on its line, where it lies farthest from curves, other lines and marks."""
    name = {0.5: "½×", 1.0: "1×"}.get(order, f"{order:g}×")
    last = min(speed[-1], top / order) if order > 0 else speed[-1]
    places = speed[0] + (last - speed[0]) * np.linspace(0.25, 0.95, 71)
    width, height = speed[-1] - speed[0], top

    def away(x):
        # In parts of the panel: to every curve, as far as it lies beside or above.
        near = [np.hypot((speed - x) / width, (values - order * x) / height).min() for values in
                [*curves, *(k * speed for k in others)]]  # fmt: skip
        near += [np.hypot((p[0] - x) / width, (p[1] - order * x) / height) for p in points]
        return min([*near, 0.1])

    at = max(places, key=lambda x: (away(x), x))
    ax.text(at, order * at, name, fontsize=8.5, color=GREY, ha="center", va="center", zorder=5,
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 1.0})  # fmt: skip


def widths(curves, height: float) -> list[float]:
    """The width of each curve of a panel (`height` in the same unit): wider under those that lie on it."""

    def on(one, other):
        known = np.isfinite(one) & np.isfinite(other)
        return known.any() and np.mean(np.abs(one - other)[known] < NEAR * height) > PART

    return [LINE + WIDER * sum(on(one, other) for other in curves[k + 1 :]) for k, one in enumerate(curves)]


def _by_direction(ax, speed, values, directions, mode, width):
    """One mode, its dashes telling the direction of whirl; segments share their ends."""
    colour, start = CYCLE[mode % len(CYCLE)], 0
    for k in range(1, len(directions) + 1):
        if k == len(directions) or directions[k] != directions[start]:
            part = slice(start, min(k + 1, len(directions)))
            # Dashes over lines, so that two modes of one frequency are both seen.
            above = 2.0 if directions[start] == "forward" else 2.5
            ax.plot(speed[part], values[part], color=colour, ls=DASHES[directions[start]][0], lw=width, zorder=above)
            start = k


def _decrements(ax, answer, speed, factor):
    shown = [np.array(mode["log_decrement"], dtype=float) for mode in answer["modes"]]
    every = np.concatenate([*shown, [0.0]])
    lowest, highest = np.nanmin(every), min(np.nanmax(every), MOST_DECREMENT)
    highest = highest if highest > 0.0 or lowest < 0.0 else 1.0
    capped = [np.minimum(values, MOST_DECREMENT) for values in shown]
    scaled, height = [np.arcsinh(values) for values in capped], np.arcsinh(highest) - np.arcsinh(lowest)
    for k, (mode, width) in enumerate(zip(answer["modes"], widths(scaled, height), strict=True)):
        _by_direction(ax, speed, capped[k], mode["directions"], k, width)
    # Linear near zero, where stability is decided; logarithmic above, where a mode dies within a cycle.
    ax.set_yscale("asinh", linear_width=1.0)
    ax.set_yticks(_ticks(lowest, highest))
    ax.yaxis.set_major_formatter(lambda value, _: number(value))
    ax.minorticks_off()
    ax.axhline(0.0, color=BLACK, lw=1.0)
    bottom = max(1.3 * lowest, -MOST_DECREMENT) if lowest < 0 else -0.15 * min(highest, 1.0)
    thresholds = [factor * point["speed"] for point in answer["thresholds"] if point["what"] == "damping"]
    if thresholds:
        # Room for the threshold's number below zero.
        bottom = min(bottom, -np.sinh(0.09 * np.arcsinh(highest)))
    ax.axhspan(bottom, 0.0, color=VERMILLION, alpha=0.08, lw=0)
    beyond = f" (beyond {MOST_DECREMENT:g}: drawn there)" if np.nanmax(every) > MOST_DECREMENT else ""
    ax.set(
        ylim=(bottom, 1.05 * highest if highest > 0.0 else -0.15 * bottom),
        ylabel=f"logarithmic decrement{beyond}",
        title="Damping",
    )
    for at in thresholds:
        _name_threshold(ax, at, speed, shown)
    below, above = np.arcsinh(-bottom), np.arcsinh(max(highest, 0.0))
    if below > NAMED * (below + above):
        _name_unstable(ax, speed, shown, below)


def _name_unstable(ax, speed, curves, depth):
    """The name of the unstable side, `depth` high, in the corner that is farthest from the curves."""
    start, end = speed[0], speed[-1]
    corners = [(side, part * depth) for part in (0.5, 0.15, 0.85) for side in ("left", "right")]

    def away(corner):
        part = speed <= start + 0.3 * (end - start) if corner[0] == "left" else speed >= end - 0.3 * (end - start)
        near = [np.nanmin(np.abs(np.arcsinh(v[part]) + corner[1]), initial=depth) for v in curves]
        return min([0.2 * depth, *near])

    side, height = max(corners, key=away)
    at = start + (0.02 if side == "left" else 0.98) * (end - start)
    ax.text(at, np.sinh(-height), "unstable", color=VERMILLION, va="center", ha=side)


def _ticks(lowest: float, highest: float) -> list[float]:
    """Zero and numbers on both sides of it that are a fifth apart and more of what is shown."""
    size = max(abs(lowest), highest)
    sizes = [t for t in TICKS if t >= min(1.0, 0.15 * size)]
    return [*(-t for t in reversed(sizes) if -t >= 1.3 * lowest), 0.0, *(t for t in sizes if t <= 1.05 * highest)]


def _name_threshold(ax, at, speed, curves):
    """The speed at which damping changes sign, on the side of its curve that is free."""
    falling = any(np.interp(at, speed, v) < 0.3 and np.interp(at, speed, np.gradient(v)) < 0 for v in curves)
    left = at > 0.5 * (speed[0] + speed[-1])
    below = falling == left
    ax.plot(at, 0.0, "o", mfc="white", mec=VERMILLION, ms=7, zorder=4)
    ax.annotate(f"{at:.5g}", (at, 0.0), xytext=(-6 if left else 6, -6 if below else 6), textcoords="offset points",
                ha="right" if left else "left", va="top" if below else "bottom", fontsize=8.5,
                color=VERMILLION)  # fmt: skip
