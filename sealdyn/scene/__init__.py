"""What a scenario may contain, as plain frozen data, and scenes made of scenes; no arrays, no files."""
