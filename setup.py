"""What a wheel holds: the package, and the folder of scenarios as the data of sealdyn.scenarios."""

from setuptools import find_packages, setup

setup(
    packages=[*find_packages(include=["sealdyn", "sealdyn.*"]), "sealdyn.scenarios"],
    package_dir={"sealdyn.scenarios": "scenarios"},
    package_data={"sealdyn": ["py.typed"], "sealdyn.scenarios": ["*.toml", "README.md"]},
)
