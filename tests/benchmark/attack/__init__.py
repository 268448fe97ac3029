"""What comes from outside and wishes the program ill; each file one kind of it, all run by robustness.py."""
