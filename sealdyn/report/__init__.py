"""Text and figures from archives."""
