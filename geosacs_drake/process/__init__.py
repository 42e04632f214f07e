"""A command as a process: its arguments, its signals, its streams, and files that are never lost."""
