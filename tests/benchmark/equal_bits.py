"""A run has the same bits whether its kernels were just compiled or loaded, in whatever order they are first used, and
with whatever vector unit they are compiled for.

    python tests/benchmark/equal_bits.py FILE

The first call writes the digests of all scenes to FILE; every other one goes through the scenes backwards and compares.
`.ci/run` calls it with kernels that are kept (NUMBA_CACHE_DIR), and with kernels just compiled for the plainest
processor (NUMBA_CPU_NAME=generic): with fast-math its sums were others.
"""

import hashlib
import json
import sys
import tempfile
import time
from pathlib import Path

import h5py

import sealdyn
from sealdyn.kernel_cache import compiling

SCENARIOS = Path(__file__).parents[2] / "scenarios"
# Scene -> what shortens it.
SCENES = {
    "fms_reference": "run.turns=3", "rub": "run.turns=3", "massless_ring": "run.turns=2",
    "fmsr_both_flexible": "run.turns=3", "hang_up": "run.turns=3", "ludwig_allen": "run.turns=1",
    "squeeze": "run.duration=0.5", "pressure_step": "run.turns=3",
}  # fmt: skip


def bits(scene, folder):
    """Number of series of a scene's archive and the digest of all that they hold in floating point."""
    archive, digest, series = Path(folder) / f"{scene}.h5", hashlib.sha256(), []
    sealdyn.simulate(sealdyn.read_scenario(SCENARIOS / f"{scene}.toml", [SCENES[scene]]), archive)
    with h5py.File(archive) as file:
        file.visititems(lambda name, item: series.append(name) if isinstance(item, h5py.Dataset) else None)
        for name in sorted(n for n in series if file[n].dtype.kind == "f"):
            digest.update(name.encode() + file[name][()].tobytes())
    return [len(series), digest.hexdigest()]


def main(file):
    """Write the digests, or compare."""
    first, compiled, begun = not file.exists(), [], time.process_time()
    compiling.append(lambda step: compiled.append(step))
    with tempfile.TemporaryDirectory() as folder:
        found = {scene: bits(scene, folder) for scene in (SCENES if first else reversed(SCENES))}
    print(
        f"{len(found)} scenes, {len(compiled) // 2} kernels compiled, {time.process_time() - begun:.0f} s", flush=True
    )
    if first:
        file.write_text(json.dumps(found))
        return 0
    kept = json.loads(file.read_text())
    other = [scene for scene in SCENES if found[scene] != kept[scene]]
    print(f"other bits: {', '.join(other) or 'none'}")
    return 1 if other else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
