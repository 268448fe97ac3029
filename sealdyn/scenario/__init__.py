"""Scenario files: TOML in, scenes out; every input error ends here."""
