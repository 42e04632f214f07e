"""The one root of this project's exceptions."""


class GeosacsError(Exception):
    """Root of all errors that this project raises on purpose."""


class InputError(GeosacsError, ValueError):
    """Input that cannot be used: the message names the value, the bound and the remedy, in one line."""
