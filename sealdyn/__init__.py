"""sealdyn: time-domain rotor dynamics of flexibly mounted mechanical face seals.

scenario = sealdyn.read_scenario("scenarios/fmr_reference.toml")
result = sealdyn.simulate(scenario, "outputs/fmr_reference.h5")
data = sealdyn.open_archive(result.archive)          # xarray Dataset
"""

from .kernel_cache import clear_stale_kernels

__version__ = "0.1.0"
__all__ = ["open_archive", "read_scenario", "run_study", "simulate", "simulate_many"]

clear_stale_kernels()


def __getattr__(name):
    # Loaded on first use, so that `sealdyn --help` answers at once.
    if name == "read_scenario":
        from .scenario.reader import read_scenario as found
    elif name == "simulate":
        from .simulation.simulate import simulate as found
    elif name == "simulate_many":
        from .simulation.batch import simulate_many as found
    elif name == "run_study":
        from .studies._runner import run_study as found
    elif name == "open_archive":
        from .archive import open_archive as found
    else:
        raise AttributeError(f"module 'sealdyn' has no attribute {name!r}")
    return found
