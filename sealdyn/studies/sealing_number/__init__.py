"""The study `sealing-number`."""
