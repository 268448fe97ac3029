"""The face of a seal on polar axes."""

# Faces narrower than this share of their radius are drawn wider.
NARROW = 0.1


def annulus(ax, inner: float, outer: float) -> str:
    """Limits of polar axes for a face between two radii (mm), which stands to scale unless it would be a line; returns
    what to write in the middle."""
    words, width = f"{inner:.4g}–{outer:.4g} mm", outer - inner
    if width < NARROW * outer:
        ax.set(ylim=(inner, outer), rorigin=inner - 2.0 * width, yticks=[])
        words += "\nwidth stretched"
    else:
        ax.set(ylim=(0, outer), yticks=[])
    ax.grid(False)
    return words


def in_the_middle(ax, words: str) -> None:
    """Words in the middle of polar axes."""
    ax.text(0.5, 0.5, words, ha="center", va="center", linespacing=1.6, transform=ax.transAxes)
