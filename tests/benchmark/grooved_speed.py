"""Processor time of a grooved film beside scipy's factors of the same matrices: python tests/benchmark/grooved_speed.py

Row gas_5bar, 16 columns to the pitch, tips bisected: the steady film against Newton's steps times one factorisation and
solve, and stiffness and damping over 60 frequencies; the least of several repetitions, one thread."""

import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

import numpy as np
from grooved_faces import GAS, R_I, R_O, SPIRAL
from scipy.sparse.linalg import splu

from sealdyn.films._grooved.balance import PERMUTATION, Assembly, Film, steady
from sealdyn.films._grooved.mesh import mesh_of
from sealdyn.films._grooved.motion import Motion
from sealdyn.numerics.interruption import one_thread


def least(function, times):
    """Least processor time (s) of so many calls."""
    spent = []
    for _ in range(times):
        start = time.process_time()
        function()
        spent.append(time.process_time() - start)
    return min(spent)


def main():
    one_thread()
    mesh = mesh_of(SPIRAL, R_I, R_O, 16)
    found = steady(mesh, GAS)
    film, assembly = Film(mesh, GAS), Assembly(mesh)
    matrix = assembly.matrix(assembly.data(film.slopes(found.p)))
    right = np.ones(assembly.free)
    factor = least(lambda: splu(matrix, permc_spec=PERMUTATION).solve(right), 20)
    plain = least(lambda: splu(matrix).solve(right), 20)
    whole = least(lambda: steady(mesh_of.__wrapped__(SPIRAL, R_I, R_O, 16), GAS), 10)
    own = least(lambda: steady(mesh, GAS), 20)
    print(f"{assembly.free} unknowns, {found.steps} Newton steps")
    print(f"factor and solve {1e3 * factor:.2f} ms ({1e3 * plain:.2f} ms as scipy orders them)")
    print(f"steady film {1e3 * own:.1f} ms, {own / (found.steps * factor):.2f} times the factors; with its mesh "
          f"{1e3 * whole:.1f} ms, {whole / (found.steps * factor):.2f} times")  # fmt: skip
    frequencies = np.linspace(10.0, 6e4, 60)
    print(f"K, D at 60 frequencies {least(lambda: [Motion(found, 1e3).matrices(w) for w in frequencies], 3):.2f} s")


if __name__ == "__main__":
    main()
