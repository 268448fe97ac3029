"""The seal in half section: radii to scale, lengths along the shaft as drawn by hand, cone and clearance enlarged; a
face with grooves also from the front, to scale."""

import numpy as np
from matplotlib.colors import ListedColormap
from matplotlib.patches import Annulus, Polygon, Rectangle

from ...quantities import in_words, printed, shown_in
from .page import BLACK, CONTACT, GREY, PALE, PAPER, RING, SKY, look, save, sheet, written
from .record import MM, Run

# Along the shaft, in widths of the face: length of a ring, clearance, cone, room for a support, and the part of a ring
# that reaches to a support or an O-ring beyond its face.
LONG, CLEARANCE, CONE, ROOM, COLLAR = 1.2, 0.08, 0.14, 1.0, 0.45
COIL = np.array([0, 0, 1, -1, 1, -1, 1, -1, 1, -1, 1, 0, 0])
# Radii at which the face is drawn.
RADII = 61
# Radii of a face from the front, and angles to a pitch; what its grooves are called.
ACROSS, AROUND = 121, 90
NAMES = {"spiral": "spiral grooves", "tee": "T-grooves", "pad": "pads", "dimples": "dimples"}


@look()
def draw(archive_path, out_path):
    """The figure alone."""
    run = Run(archive_path)
    grooved = [(ring, row) for ring in RING for row in (run.resolved.get(ring) or {}).get("grooves") or []]
    figure = sheet(9.6 if grooved else 6.0, 4.4)
    panel(figure.add_axes((0.08, 0.16, 0.53, 0.75) if grooved else (0.13, 0.16, 0.85, 0.75)), run)
    for ring, row in grooved:
        _front(figure.add_axes((0.63, 0.16, 0.36, 0.75)), run, ring, row)
    return save(figure, out_path)


def _front(ax, run: Run, ring: str, row: dict) -> None:
    """The face of a ring with its grooves, seen so that theta rises counter-clockwise; which way it turns past the
    other one."""
    count = row["count"]
    inner, outer = run.film("inner_radius"), run.film("outer_radius")
    r = np.linspace(inner, outer, ACROSS)
    theta = np.linspace(0.0, 2.0 * np.pi, AROUND * count + 1)
    deep = _is_deep(row, r[:, None], theta)
    x, y = (MM * r[:, None] * turned for turned in (np.cos(theta), np.sin(theta)))
    # A face for the lands, on which only what is deep is drawn.
    ax.add_patch(Annulus((0, 0), MM * outer, MM * (outer - inner), fc=RING[ring], alpha=0.75, ec=BLACK))
    ax.pcolormesh(x, y, np.where(deep[:-1, :-1], 1.0, np.nan), cmap=ListedColormap([GREY]), rasterized=True)
    other = "stator" if ring == "rotor" else "rotor"
    if past := _fastest(run, ring) - _fastest(run, other):
        ends = np.radians([65.0, 115.0])[:: 1 if past > 0.0 else -1]
        start, end = (1.1 * MM * outer * np.array([np.cos(at), np.sin(at)]) for at in ends)
        bend = 0.22 if past > 0.0 else -0.22
        ax.annotate("", end, start, arrowprops={"arrowstyle": "->", "lw": 1.5, "connectionstyle": f"arc3,rad={bend}"})
    # The other face drags its fluid against the way that this one turns past it.
    pumped = "inwards" if (row["angle"] or 0.0) * past > 0.0 else "outwards"
    pumped = pumped if past and row["shape"] == "spiral" else ""
    words = [f"{count} {NAMES[row['shape']]}, {_length(row['depth'])} deep", pumped and f"pump {pumped}",
             past and f"arrow: as seen from the {other}"]  # fmt: skip
    ax.set(xlim=(-1.2 * MM * outer, 1.2 * MM * outer), ylim=(-1.2 * MM * outer, 1.2 * MM * outer), aspect="equal",
           xticks=[], yticks=[], title=f"Face of the {ring}, to scale")  # fmt: skip
    ax.set_xlabel("\n".join(filter(None, words)), fontsize=8)
    ax.grid(visible=False)
    ax.spines[:].set_visible(False)


def _is_deep(row: dict, r, theta) -> np.ndarray:
    """Whether a face with a row of grooves is deeper at radii r (m) and angles theta (rad), which broadcast."""
    pitch = 2.0 * np.pi / row["count"]
    if row["shape"] == "dimples":
        off = np.mod(theta - row["phase"] + 0.5 * pitch, pitch) - 0.5 * pitch
        y, angle, deep = row["radius"] * np.log(r / row["radius"]), row["angle"] or 0.0, False
        # Neighbours may overlap.
        for x in (row["radius"] * (off + turned) for turned in (-pitch, 0.0, pitch)):
            along, across = x * np.cos(angle) + y * np.sin(angle), y * np.cos(angle) - x * np.sin(angle)
            deep = deep | (np.hypot(2.0 * along / row["length"], 2.0 * across / row["width"]) < 1.0)
        return deep
    low, high = row["inner_radius"], row["outer_radius"]
    bend = np.log(r / low) / np.tan(row["angle"]) if row["shape"] == "spiral" else 0.0
    share = np.abs(np.mod((theta - row["phase"] - bend) / pitch + 0.5, 1.0) - 0.5) * 2.0
    deep = (r >= low) & (r <= high) & (share <= row["share"])
    if row["shape"] == "tee":
        deep |= (r >= high) & (r <= row["stem_outer_radius"]) & (share <= row["stem_share"])
    return deep


def _fastest(run: Run, ring: str) -> float:
    """Speed of a ring's carrier (rad/s), of one that changes the largest."""
    value = (run.resolved["shaft" if ring == "rotor" else "stator"] or {}).get("speed") or 0.0
    return max(value["value"], key=abs) if isinstance(value, dict) else value


def panel(ax, run: Run) -> None:
    """Rings, film, supports, secondary seals and balance radius over the radius (mm)."""
    inner, outer = MM * run.film("inner_radius"), MM * run.film("outer_radius")
    width = outer - inner
    radii, gap = np.linspace(inner, outer, RADII), width * _gap(run)
    back = CLEARANCE * width + CONE * width + LONG * width
    ends = {"rotor": (-LONG * width, -1), "stator": (back, 1)}
    ax.add_patch(Polygon([*zip(gap, radii, strict=True), (0, outer), (0, inner)], fc=SKY, alpha=0.5, lw=0))
    ax.add_patch(Rectangle((-LONG * width, inner), LONG * width, width, fc=RING["rotor"], alpha=0.75, ec=BLACK))
    stator = [*zip(gap, radii, strict=True), (back, outer), (back, inner)]
    ax.add_patch(Polygon(stator, fc=RING["stator"], alpha=0.75, ec=BLACK))
    balance, ratio = _balance(run, inner, outer)
    reached = [inner, outer]
    for ring, (end, way) in ends.items():
        ax.text(end - way * 0.75 * LONG * width, inner + 0.5 * width, ring, ha="center", va="center", rotation=90)
        reached += _held(ax, run, ring, end, way, width, balance)
    if balance is not None:
        ax.axhline(balance, color=CONTACT, lw=0.9, ls="--", zorder=3)
        reached.append(balance)
    _pressures(ax, run, inner, outer, width, gap)
    reach = LONG + 1.3 * ROOM
    ax.set(xlim=(-reach * width, back + 1.3 * ROOM * width),
           ylim=(min(reached) - 0.5 * width, max(reached) + 0.5 * width))  # fmt: skip
    ax.set(ylabel="radius, mm", xticks=[], title="Radii to scale; cone and clearance enlarged")
    dashed = [] if balance is None else [f"dashed: balance radius {balance:.4g} mm, balance ratio {ratio:.3g}"]
    ax.set_xlabel("\n".join([*dashed, *_not_drawn(run)]), fontsize=8, color=CONTACT if dashed else BLACK)
    ax.grid(axis="x", visible=False)


def _gap(run: Run) -> np.ndarray:
    """The gap over the radius, in widths of the face: cone and profile enlarged to the same height for every seal."""
    film = [run.film("inner_radius"), run.film("outer_radius")]
    shape = np.broadcast_to(run.shape(np.linspace(*film, RADII)), RADII)
    rise = shape - shape.min()
    return CLEARANCE + (CONE * rise / rise.max() if rise.max() > 0 else rise)


def _pressures(ax, run: Run, inner: float, outer: float, width: float, gap) -> None:
    """The pressures at both edges of the face; from the lowest to the highest of one that changes with time."""
    for key, radius, way, at in (("outer_pressure", outer, 1, gap[-1]), ("inner_pressure", inner, -1, gap[0])):
        value = (run.resolved.get("film") or {}).get(key)
        values = value["value"] if isinstance(value, dict) else [value]
        if None not in values:
            unit, per = shown_in("pressure")
            words = " to ".join(dict.fromkeys(f"{per * p:.4g}" for p in (min(values), max(values))))
            side = "bottom" if way > 0 else "top"
            ax.text(0.5 * at, radius + way * 0.06 * width, f"{words} {unit} abs.", ha="center", va=side, fontsize=8)


def _held(ax, run: Run, ring: str, end: float, way: int, width: float, balance: float | None) -> list[float]:
    """What carries a ring: a spring at the radius of its support, or nothing that gives; its secondary seal.  Returns
    the radii (mm) that this reaches."""
    table = run.resolved.get(ring) or {}
    support, seal = table.get("support"), table.get("secondary_seal")
    inner, outer = MM * run.film("inner_radius"), MM * run.film("outer_radius")
    middle, wall = 0.5 * (inner + outer), end + way * ROOM * width
    reached = []
    if support:
        given = _has_radius(support)
        radius = MM * support["radius"] if given else middle
        tilt = np.atleast_1d(support.get("tilt_stiffness") or 0.0)
        stiff = ", ".join(written(k, 3) for k in tilt)
        words = f"support, r {radius:.4g}" if given else f"support,\n{stiff} N m/rad"
        ax.plot(np.linspace(end, wall, len(COIL)), radius + 0.09 * width * COIL, color=BLACK, lw=1.2)
        ax.plot([wall, wall], [radius - 0.4 * width, radius + 0.4 * width], color=BLACK, lw=2.5)
        # On the side of the spring that the line of the balance radius leaves free.
        side = -1 if balance is not None and radius < balance < radius + 0.5 * width else 1
        ax.text(0.5 * (end + wall), radius + side * 0.16 * width, words, ha="center",
                va="bottom" if side > 0 else "top", fontsize=7.5)  # fmt: skip
        reached += [radius - 0.4 * width, radius + 0.4 * width]
    else:
        ax.add_patch(Rectangle((min(end, wall), middle - 0.5 * width), ROOM * width, width, fc=PALE, ec=GREY))
        fixed = "on the shaft" if ring == "rotor" else "on its carrier" if table.get("speed") else "in the housing"
        ax.text(0.5 * (end + wall), middle, fixed, ha="center", va="center", fontsize=7.5, rotation=90)
    if seal:
        radius = MM * seal["radius"]
        place = end - way * 0.2 * LONG * width
        ax.plot(place, radius, "o", ms=11, color=BLACK, zorder=4)
        # Beyond the ring, where its name does not lie on that of the ring.
        side = -1 if radius < inner else 1
        beyond = max(radius, outer) if side > 0 else radius
        ax.text(place, beyond + side * 0.14 * width, f"O-ring, r {radius:.4g}", ha="center",
                va="bottom" if side > 0 else "top", fontsize=7.5, bbox=PAPER)  # fmt: skip
        reached += [radius, beyond + side * 0.2 * width]
    carried = [MM * table[part]["radius"] for part in ("support", "secondary_seal") if _has_radius(table.get(part))]
    if carried:
        _collar(ax, ring, end, way, (inner, outer), carried)
    return reached


def _has_radius(part: dict | None) -> bool:
    """A support may be given by its tilt stiffness instead."""
    return bool(part and part.get("radius"))


def _collar(ax, ring: str, end: float, way: int, face: tuple[float, float], carried: list[float]) -> None:
    """The back of a ring, which ends at `end`, as far as the radii (mm) beyond its `face` at which it is carried."""
    inner, outer = face
    low, high = min(inner, *carried), max(outer, *carried)
    long = COLLAR * LONG * (outer - inner)
    start = end - long if way > 0 else end
    for edge, height in ((low, inner - low), (outer, high - outer)):
        if height > 0:
            ax.add_patch(Rectangle((start, edge), long, height, fc=RING[ring], alpha=0.75, ec=BLACK))


def _balance(run: Run, inner: float, outer: float) -> tuple[float | None, float]:
    """The radius (mm) at which the closing pressure ends, from the balance ratio and the side of the higher pressure,
    and that ratio; None where there is none."""
    ratio = (run.summary.get("closing") or {}).get("balance_ratio")
    pressures = [run.film(key) for key in ("outer_pressure", "inner_pressure")]
    if ratio is None or None in pressures or pressures[0] == pressures[1]:
        return None, 0.0
    area = ratio * (outer**2 - inner**2)
    square = outer**2 - area if pressures[0] > pressures[1] else inner**2 + area
    return (square**0.5 if square > 0 else None), ratio


def _length(value: float) -> str:
    return printed(in_words("m", value, digits=3))


def _not_drawn(run: Run) -> list[str]:
    """What the faces have around the circle, which a section does not show."""
    found = []
    for ring in RING:
        waves = (run.resolved.get(ring) or {}).get("waviness") or []
        found += [f"{wave['order']} waves of {_length(wave['amplitude'])} in the {ring}'s face" for wave in waves]
    pads = (run.resolved.get("film") or {}).get("pads") or []
    found += [f"{pad['count']} pads {_length(pad['depth'])} deep" for pad in pads]
    return [f"not drawn: {', '.join(found)}"] if found else []
