"""One run: choice of film and method, trajectory, archive, certificate, summary."""
