"""The study `rub`."""
